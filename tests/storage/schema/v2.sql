-- Schema version 2: that of version 1 brought up to date. Never changed after its release.
PRAGMA application_id=1213156681;
PRAGMA user_version=2;
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE journeys (
  journey_id        INTEGER PRIMARY KEY,
  name              TEXT    NOT NULL UNIQUE,
  state             TEXT    NOT NULL CHECK (state IN ('ACTIVE', 'FINISHED')),
  writer_id         TEXT    NOT NULL,
  readers           TEXT    NOT NULL,
  input             TEXT    NOT NULL CHECK (input IN ('UNKNOWN', 'FRAMES', 'FLOW_VECTORS')),
  next_sequence     INTEGER NOT NULL,
  create_time_ns    INTEGER NOT NULL,
  start_time_ns     INTEGER NOT NULL,
  end_time_ns       INTEGER NOT NULL,
  step_count        INTEGER NOT NULL,
  landmark_count    INTEGER NOT NULL,
  fingerprint_count INTEGER NOT NULL,
  settings          TEXT    NOT NULL
) STRICT;
INSERT INTO journeys VALUES(1,'robots/old/journeys/1','ACTIVE','writer','["robots/a","*"]','FLOW_VECTORS',12,1700000000123456789,1000000000,1000000011,12,9,33,'{"deviation_model":{"height":240,"ks_distance":0.0123,"mu":2.24,"observations":1000,"sigma":0.86,"width":320},"deviation_model_name":"deviationModels/wide \"quoted\"","flow":{"cell_px":9,"max_forward_backward_px":0.5,"min_eigenvalue":0.003,"normalization_floor":4.0,"normalization_window_px":31,"pyramid_levels":3,"smoothing_sigma_px":0.30000000000000004,"window_px":15,"working_width_px":320},"landmark":{"histogram_bins":16,"max_track_distance_px":20.0,"max_track_gap_steps":3,"max_valley_ratio":0.5,"min_peak_share":0.14285714285714285,"min_vector_length_px":0.5,"min_vectors":8},"left_camera":{"distortion":[0.1,-0.02,0.001,1e-17,0.3333333333333333],"height":240,"intrinsics":{"center_x":160.25,"center_y":119.75,"focal_x":277.1,"focal_y":276.9},"width":320,"yaw_rad":-0.05},"right_camera":{"distortion":[0.0,0.0,0.0,0.0,0.0],"height":480,"width":640,"yaw_rad":0.0}}');
CREATE TABLE landmarks (
  journey_id        INTEGER NOT NULL REFERENCES journeys ON DELETE CASCADE,
  landmark          INTEGER NOT NULL,
  side              TEXT    NOT NULL CHECK (side IN ('LEFT', 'RIGHT')),
  first_step        INTEGER NOT NULL,
  last_step         INTEGER NOT NULL,
  fingerprint_count INTEGER NOT NULL,
  spread            REAL    NOT NULL,
  PRIMARY KEY (journey_id, landmark)
) STRICT, WITHOUT ROWID;
INSERT INTO landmarks VALUES(1,0,'LEFT',0,0,1,0.30090270812437314162);
INSERT INTO landmarks VALUES(1,1,'RIGHT',0,3,4,0.53686058174523565433);
INSERT INTO landmarks VALUES(1,2,'LEFT',1,2,2,0.42427281845536612969);
INSERT INTO landmarks VALUES(1,3,'LEFT',3,11,9,0.73063635350495936826);
INSERT INTO landmarks VALUES(1,4,'RIGHT',4,9,6,0.40086927449013709523);
INSERT INTO landmarks VALUES(1,5,'LEFT',5,9,5,0.51574724172517549813);
INSERT INTO landmarks VALUES(1,6,'LEFT',10,11,2,0.21464393179538615585);
INSERT INTO landmarks VALUES(1,7,'RIGHT',10,11,2,0.31695085255767302401);
INSERT INTO landmarks VALUES(1,8,'RIGHT',10,11,2,0.43179538615847545823);
CREATE TABLE fingerprints (
  fingerprint_id INTEGER PRIMARY KEY,
  landmark       INTEGER NOT NULL,
  x              REAL    NOT NULL,
  y              REAL    NOT NULL,
  count          INTEGER NOT NULL,
  journey_id     INTEGER AS (fingerprint_id >> 27) VIRTUAL,
  step           INTEGER AS (fingerprint_id >> 2 & 0x1ffffff) VIRTUAL
) STRICT;
INSERT INTO fingerprints VALUES(134217728,0,0.2776260077953338623,91.126419067382812503,142);
INSERT INTO fingerprints VALUES(134217729,1,1.8867930173873901367,83.196426391601562503,187);
INSERT INTO fingerprints VALUES(134217732,2,0.66864401102066040039,124.78913116455078124,212);
INSERT INTO fingerprints VALUES(134217733,1,7.722454071044921875,66.518890380859374998,115);
INSERT INTO fingerprints VALUES(134217736,2,16.671155929565429687,111.35047149658203125,30);
INSERT INTO fingerprints VALUES(134217737,1,7.1018347740173339843,113.29968261718749999,183);
INSERT INTO fingerprints VALUES(134217740,3,5.2271528244018554687,1.1862499713897705078,86);
INSERT INTO fingerprints VALUES(134217741,1,16.14432525634765625,2.594660043716430664,141);
INSERT INTO fingerprints VALUES(134217744,3,16.022039413452148437,91.742462158203124996,20);
INSERT INTO fingerprints VALUES(134217745,4,2.7053160667419433593,155.87109375,35);
INSERT INTO fingerprints VALUES(134217748,3,5.566226959228515625,119.56308746337890625,184);
INSERT INTO fingerprints VALUES(134217749,5,167.42791748046875,34.55532073974609375,186);
INSERT INTO fingerprints VALUES(134217750,4,14.641497611999511718,65.70024871826171875,128);
INSERT INTO fingerprints VALUES(134217752,3,11.495401382446289062,58.747909545898437501,69);
INSERT INTO fingerprints VALUES(134217753,5,162.95445251464843749,19.961420059204101562,109);
INSERT INTO fingerprints VALUES(134217754,4,8.9897708892822265625,41.560321807861328124,149);
INSERT INTO fingerprints VALUES(134217756,3,6.2375288009643554687,139.65069580078124999,216);
INSERT INTO fingerprints VALUES(134217757,5,170.59175109863281249,154.3984832763671875,57);
INSERT INTO fingerprints VALUES(134217758,4,1.6181919574737548828,103.59014892578125,101);
INSERT INTO fingerprints VALUES(134217760,3,14.916507720947265625,15.443070411682128905,116);
INSERT INTO fingerprints VALUES(134217761,5,166.318817138671875,30.175149917602539062,22);
INSERT INTO fingerprints VALUES(134217762,4,13.007659912109375,120.42874908447265625,139);
INSERT INTO fingerprints VALUES(134217764,3,9.3855638504028320312,35.79904937744140625,158);
INSERT INTO fingerprints VALUES(134217765,5,171.389434814453125,137.71258544921875,193);
INSERT INTO fingerprints VALUES(134217766,4,0.36789399385452270507,59.039070129394531248,126);
INSERT INTO fingerprints VALUES(134217768,3,16.53997039794921875,51.089160919189453126,174);
INSERT INTO fingerprints VALUES(134217769,6,163.101837158203125,121.59104156494140625,154);
INSERT INTO fingerprints VALUES(134217770,7,16.398210525512695312,129.24746704101562499,194);
INSERT INTO fingerprints VALUES(134217771,8,168.04248046874999999,82.179817199707031246,30);
INSERT INTO fingerprints VALUES(134217772,3,6.4233231544494628906,19.393079757690429687,44);
INSERT INTO fingerprints VALUES(134217773,6,174.26831054687499999,23.602640151977539062,108);
INSERT INTO fingerprints VALUES(134217774,7,10.708180427551269531,75.784622192382812499,195);
INSERT INTO fingerprints VALUES(134217775,8,170.64445495605468749,20.561330795288085937,217);
CREATE TABLE deviation_models (
  name           TEXT    NOT NULL PRIMARY KEY,
  mu             REAL    NOT NULL,
  sigma          REAL    NOT NULL,
  observations   INTEGER NOT NULL,
  ks_distance    REAL    NOT NULL,
  width          INTEGER NOT NULL,
  height         INTEGER NOT NULL,
  training       TEXT    NOT NULL,
  create_time_ns INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO deviation_models VALUES('deviationModels/old',2.2400000000000002131,0.85999999999999998667,1000,0.0,0,0,'{"distance_deviation_m":3.0,"distance_mean_m":11.0,"elapsed_s":1.1,"focal_px":277.0,"frame_interval_s":0.1,"height":240,"lateral_offset_m":2.75,"observations":1000,"seed":7,"velocity_deviation_kmh":1.0,"velocity_mean_kmh":4.0,"vertical_offset_m":0.5,"width":320}',1);
CREATE TABLE profiles (
  profile_id INTEGER PRIMARY KEY,
  cells      BLOB    NOT NULL,
  journey_id INTEGER AS (profile_id >> 27) VIRTUAL,
  step       INTEGER AS (profile_id >> 2 & 0x1ffffff) VIRTUAL,
  side       TEXT    AS (CASE profile_id & 3 WHEN 0 THEN 'LEFT' ELSE 'RIGHT' END) VIRTUAL
) STRICT;
CREATE TRIGGER journey_deleted AFTER DELETE ON journeys BEGIN
  DELETE FROM fingerprints
  WHERE fingerprint_id BETWEEN OLD.journey_id << 27 AND (OLD.journey_id << 27) + 0x7ffffff;
END;
CREATE VIEW journey_landmarks AS
  SELECT j.name AS journey, l.landmark, l.side, l.first_step, l.last_step, l.fingerprint_count,
         l.spread
  FROM journeys j JOIN landmarks l USING (journey_id);
CREATE VIEW journey_fingerprints AS
  SELECT j.name AS journey, f.step, l.side, f.landmark, f.x, f.y, f.count
  FROM journeys j
  JOIN fingerprints f
    ON f.fingerprint_id BETWEEN j.journey_id << 27 AND (j.journey_id << 27) + 0x7ffffff
  JOIN landmarks l ON l.journey_id = j.journey_id AND l.landmark = f.landmark;
CREATE TRIGGER journey_profiles_deleted AFTER DELETE ON journeys BEGIN
  DELETE FROM profiles
  WHERE profile_id BETWEEN OLD.journey_id << 27 AND (OLD.journey_id << 27) + 0x7ffffff;
END;
COMMIT;
