#include "storage/schema.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

// From version 0 (empty) to 1.
constexpr char kVersion1[] = R"sql(
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

-- fingerprint_id = journey_id * 2^27 + step * 4 + index within the step.
CREATE TABLE fingerprints (
  fingerprint_id INTEGER PRIMARY KEY,
  landmark       INTEGER NOT NULL,
  x              REAL    NOT NULL,
  y              REAL    NOT NULL,
  count          INTEGER NOT NULL,
  journey_id     INTEGER AS (fingerprint_id >> 27) VIRTUAL,
  step           INTEGER AS (fingerprint_id >> 2 & 0x1ffffff) VIRTUAL
) STRICT;

CREATE TRIGGER journey_deleted AFTER DELETE ON journeys BEGIN
  DELETE FROM fingerprints
  WHERE fingerprint_id BETWEEN OLD.journey_id << 27 AND (OLD.journey_id << 27) + 0x7ffffff;
END;

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
)sql";

// From version 1 to 2: flow profiles. Older journeys have none.
constexpr char kVersion2[] = R"sql(
-- profile_id = journey_id * 2^27 + step * 4 + side (0 left, 1 right). cells: twelve bytes with a bit
-- a cell that is not 0, then those cells.
CREATE TABLE profiles (
  profile_id INTEGER PRIMARY KEY,
  cells      BLOB    NOT NULL,
  journey_id INTEGER AS (profile_id >> 27) VIRTUAL,
  step       INTEGER AS (profile_id >> 2 & 0x1ffffff) VIRTUAL,
  side       TEXT    AS (CASE profile_id & 3 WHEN 0 THEN 'LEFT' ELSE 'RIGHT' END) VIRTUAL
) STRICT;

CREATE TRIGGER journey_profiles_deleted AFTER DELETE ON journeys BEGIN
  DELETE FROM profiles
  WHERE profile_id BETWEEN OLD.journey_id << 27 AND (OLD.journey_id << 27) + 0x7ffffff;
END;
)sql";

// From version 2 to 3: a step is one row in one page; it was up to ten rows in three tables
// (docs/decisions). A landmark's own values become those of each of its steps. The settings move to
// another table: they are ten times as long as the rest of a journey's row, which changes with each
// step.
constexpr char kVersion3[] = R"sql(
DROP VIEW journey_landmarks;
DROP VIEW journey_fingerprints;
DROP TRIGGER journey_deleted;
DROP TRIGGER journey_profiles_deleted;

CREATE TABLE journey_settings (
  journey_id INTEGER PRIMARY KEY REFERENCES journeys ON DELETE CASCADE,
  settings   TEXT    NOT NULL
) STRICT;
INSERT INTO journey_settings SELECT journey_id, settings FROM journeys;
ALTER TABLE journeys DROP COLUMN settings;

-- step_id = journey_id * 2^25 + step. NULL: fewer than two fingerprints on that side; no profile.
CREATE TABLE steps (
  step_id         INTEGER PRIMARY KEY,
  left1_landmark  INTEGER, left1_x  REAL, left1_y  REAL, left1_count  INTEGER, left1_spread  REAL,
  left2_landmark  INTEGER, left2_x  REAL, left2_y  REAL, left2_count  INTEGER, left2_spread  REAL,
  right1_landmark INTEGER, right1_x REAL, right1_y REAL, right1_count INTEGER, right1_spread REAL,
  right2_landmark INTEGER, right2_x REAL, right2_y REAL, right2_count INTEGER, right2_spread REAL,
  left_profile    BLOB,
  right_profile   BLOB,
  journey_id      INTEGER AS (step_id >> 25) VIRTUAL,
  step            INTEGER AS (step_id & 0x1ffffff) VIRTUAL
) STRICT;

WITH places AS (
  SELECT f.fingerprint_id >> 2 AS step_id,
         l.side || row_number() OVER (
           PARTITION BY f.fingerprint_id >> 2, l.side ORDER BY f.fingerprint_id) AS place,
         f.landmark, f.x, f.y, f.count, l.spread
  FROM fingerprints f
  JOIN landmarks l ON l.journey_id = f.fingerprint_id >> 27 AND l.landmark = f.landmark)
INSERT INTO steps
SELECT step_id,
       max(landmark) FILTER (WHERE place = 'LEFT1'), max(x) FILTER (WHERE place = 'LEFT1'),
       max(y) FILTER (WHERE place = 'LEFT1'), max(count) FILTER (WHERE place = 'LEFT1'),
       max(spread) FILTER (WHERE place = 'LEFT1'),
       max(landmark) FILTER (WHERE place = 'LEFT2'), max(x) FILTER (WHERE place = 'LEFT2'),
       max(y) FILTER (WHERE place = 'LEFT2'), max(count) FILTER (WHERE place = 'LEFT2'),
       max(spread) FILTER (WHERE place = 'LEFT2'),
       max(landmark) FILTER (WHERE place = 'RIGHT1'), max(x) FILTER (WHERE place = 'RIGHT1'),
       max(y) FILTER (WHERE place = 'RIGHT1'), max(count) FILTER (WHERE place = 'RIGHT1'),
       max(spread) FILTER (WHERE place = 'RIGHT1'),
       max(landmark) FILTER (WHERE place = 'RIGHT2'), max(x) FILTER (WHERE place = 'RIGHT2'),
       max(y) FILTER (WHERE place = 'RIGHT2'), max(count) FILTER (WHERE place = 'RIGHT2'),
       max(spread) FILTER (WHERE place = 'RIGHT2'),
       NULL, NULL
FROM places GROUP BY step_id ORDER BY step_id;
INSERT INTO steps (step_id, left_profile)
SELECT profile_id >> 2, cells FROM profiles WHERE profile_id & 3 = 0 ORDER BY profile_id
ON CONFLICT DO UPDATE SET left_profile = excluded.left_profile;
INSERT INTO steps (step_id, right_profile)
SELECT profile_id >> 2, cells FROM profiles WHERE profile_id & 3 = 1 ORDER BY profile_id
ON CONFLICT DO UPDATE SET right_profile = excluded.right_profile;

DROP TABLE fingerprints;
DROP TABLE landmarks;
DROP TABLE profiles;

CREATE TRIGGER journey_deleted AFTER DELETE ON journeys BEGIN
  DELETE FROM steps
  WHERE step_id BETWEEN OLD.journey_id << 25 AND (OLD.journey_id << 25) + 0x1ffffff;
END;

CREATE VIEW journey_fingerprints AS
  SELECT j.name AS journey, s.step, CASE WHEN place < 2 THEN 'LEFT' ELSE 'RIGHT' END AS side,
         CASE place WHEN 0 THEN left1_landmark WHEN 1 THEN left2_landmark WHEN 2 THEN right1_landmark
                    ELSE right2_landmark END AS landmark,
         CASE place WHEN 0 THEN left1_x WHEN 1 THEN left2_x WHEN 2 THEN right1_x
                    ELSE right2_x END AS x,
         CASE place WHEN 0 THEN left1_y WHEN 1 THEN left2_y WHEN 2 THEN right1_y
                    ELSE right2_y END AS y,
         CASE place WHEN 0 THEN left1_count WHEN 1 THEN left2_count WHEN 2 THEN right1_count
                    ELSE right2_count END AS count,
         CASE place WHEN 0 THEN left1_spread WHEN 1 THEN left2_spread WHEN 2 THEN right1_spread
                    ELSE right2_spread END AS spread
  FROM journeys j
  JOIN steps s ON s.step_id BETWEEN j.journey_id << 25 AND (j.journey_id << 25) + 0x1ffffff
  JOIN (SELECT 0 AS place UNION ALL SELECT 1 UNION ALL SELECT 2 UNION ALL SELECT 3)
  WHERE CASE place WHEN 0 THEN left1_landmark WHEN 1 THEN left2_landmark
                   WHEN 2 THEN right1_landmark ELSE right2_landmark END IS NOT NULL;

CREATE VIEW journey_landmarks AS
  SELECT journey, landmark, side, min(step) AS first_step, max(step) AS last_step,
         count(*) AS fingerprint_count, avg(spread) AS spread
  FROM journey_fingerprints GROUP BY journey, landmark;
)sql";

// From version 3 to 4: each step keeps the frame that made it, and has a row for that; a journey
// keeps what recording must see again. Until then each frame but the first made a step.
constexpr char kVersion4[] = R"sql(
ALTER TABLE journeys ADD COLUMN resend_from INTEGER NOT NULL DEFAULT 0;
UPDATE journeys
SET resend_from = CASE input WHEN 'FLOW_VECTORS' THEN next_sequence ELSE max(next_sequence - 1, 0) END;

-- NULL, as where a step has no row: one after that of the step before, 1 for the first step.
ALTER TABLE steps ADD COLUMN sequence INTEGER;
INSERT OR IGNORE INTO steps (step_id)
SELECT (journey_id << 25) + step_count - 1 FROM journeys WHERE step_count BETWEEN 1 AND 0x1ffffff;
UPDATE steps SET sequence = step_id & 0x1ffffff;
UPDATE steps SET sequence = sequence + 1
WHERE step_id >> 25 NOT IN (SELECT journey_id FROM journeys WHERE input = 'FLOW_VECTORS');
)sql";

// kMigrations[v] migrates from version v to v + 1. A released migration never changes.
constexpr std::array<const char*, kSchemaVersion> kMigrations = {kVersion1, kVersion2, kVersion3,
                                                                 kVersion4};

absl::Status CheckOwner(Connection& connection, std::int64_t version) {
  const std::int64_t application = connection.Integer("PRAGMA application_id");
  const bool empty = connection.Integer("SELECT count(*) FROM sqlite_schema") == 0;
  if (application == kApplicationId || (empty && application == 0 && version == 0)) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(absl::StrCat("store: application_id is ", application,
                                                    ", not ", kApplicationId,
                                                    ": the file is another program's database"));
}

}  // namespace

absl::Status CheckOwnFile(Connection& connection) {
  const std::int64_t version = connection.Integer("PRAGMA user_version");
  HOMING_RETURN_IF_ERROR(CheckOwner(connection, version));
  return CheckNotNewer(version, kSchemaVersion);
}

absl::Status CheckSchema(Connection& connection) {
  return connection.Read([&]() -> absl::Status {
    HOMING_RETURN_IF_ERROR(CheckOwnFile(connection));
    const std::int64_t version = connection.Integer("PRAGMA user_version");
    return CheckSameVersion(version, kSchemaVersion);
  });
}

absl::Status TouchSchemaVersion(Connection& connection) {
  connection.Execute(
      absl::StrCat("PRAGMA user_version=", connection.Integer("PRAGMA user_version")));
  return absl::OkStatus();
}

absl::Status Migrate(Connection& connection) {
  return connection.Write([&]() -> absl::Status {
    HOMING_RETURN_IF_ERROR(CheckOwnFile(connection));
    const std::int64_t version = connection.Integer("PRAGMA user_version");
    for (std::int64_t from = version; from < kSchemaVersion; ++from) {
      connection.Execute(kMigrations[static_cast<std::size_t>(from)]);
    }
    if (version < kSchemaVersion) {
      connection.Execute(absl::StrCat("PRAGMA application_id=", kApplicationId));
      connection.Execute(absl::StrCat("PRAGMA user_version=", kSchemaVersion));
    }
    return absl::OkStatus();
  });
}

}  // namespace homing::storage
