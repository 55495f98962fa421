#include "storage/postgres/pg_schema.h"

#include <array>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/store_errors.h"

namespace homing::storage::postgres {
namespace {

constexpr char kFindVersionTable[] =
    "SELECT count(*) FROM pg_catalog.pg_class WHERE oid = to_regclass('homing_schema')";
constexpr char kReadVersion[] = "SELECT version FROM homing_schema";

// A journey's row changes with each step: half of each page is left for the changed rows, so that
// no index changes. Steps are written once. A fingerprint is 25 bytes: side (0 left, 1 right),
// landmark, x and y (float32), count, spread (float64), most significant byte first.
constexpr char kVersion1[] = R"sql(
CREATE TABLE homing_schema (version bigint NOT NULL);
INSERT INTO homing_schema VALUES (0);

CREATE SEQUENCE journey_epochs;

CREATE TABLE servers (
  server_id bigint      PRIMARY KEY,
  beat_at   timestamptz NOT NULL
);

CREATE TABLE journeys (
  journey_id        bigint NOT NULL PRIMARY KEY,
  name              text   COLLATE "C" NOT NULL,
  state             text   NOT NULL CHECK (state IN ('ACTIVE', 'FINISHED')),
  writer_id         text   NOT NULL,
  readers           text   NOT NULL,
  input             text   NOT NULL CHECK (input IN ('UNKNOWN', 'FRAMES', 'FLOW_VECTORS')),
  next_sequence     bigint NOT NULL,
  resend_from       bigint NOT NULL,
  create_time_ns    bigint NOT NULL,
  start_time_ns     bigint NOT NULL,
  end_time_ns       bigint NOT NULL,
  step_count        bigint NOT NULL,
  landmark_count    bigint NOT NULL,
  fingerprint_count bigint NOT NULL,
  epoch             bigint NOT NULL DEFAULT 0,
  server_id         bigint NOT NULL DEFAULT 0,
  written_at        timestamptz NOT NULL DEFAULT '-infinity',
  revision          bigint NOT NULL DEFAULT 0
) WITH (fillfactor = 50);
CREATE INDEX journeys_by_name ON journeys (name);

CREATE TABLE journey_settings (
  journey_id bigint NOT NULL PRIMARY KEY REFERENCES journeys ON DELETE CASCADE,
  settings   text   NOT NULL
);

CREATE TABLE steps (
  journey_id    bigint NOT NULL,
  step          bigint NOT NULL,
  sequence      bigint,
  fingerprints  bytea  NOT NULL,
  left_profile  bytea,
  right_profile bytea,
  PRIMARY KEY (journey_id, step)
);
ALTER TABLE steps ALTER fingerprints SET STORAGE PLAIN, ALTER left_profile SET STORAGE PLAIN,
  ALTER right_profile SET STORAGE PLAIN;

CREATE TABLE deviation_models (
  name           text   COLLATE "C" NOT NULL PRIMARY KEY,
  mu             double precision NOT NULL,
  sigma          double precision NOT NULL,
  observations   bigint NOT NULL,
  ks_distance    double precision NOT NULL,
  width          bigint NOT NULL,
  height         bigint NOT NULL,
  training       text   NOT NULL,
  create_time_ns bigint NOT NULL
);
)sql";

constexpr char kViews1[] = R"sql(
CREATE FUNCTION homing_int4(bytes bytea, at int) RETURNS bigint LANGUAGE sql IMMUTABLE AS $$
  SELECT (get_byte(bytes, at)::bigint << 24) + (get_byte(bytes, at + 1) << 16)
         + (get_byte(bytes, at + 2) << 8) + get_byte(bytes, at + 3) $$;
CREATE FUNCTION homing_float4(bytes bytea, at int) RETURNS double precision
LANGUAGE sql IMMUTABLE AS $$
  SELECT CASE WHEN bits >> 31 = 1 THEN -1 ELSE 1 END
         * CASE bits >> 23 & 255 WHEN 0 THEN (bits & 8388607) * power(2::float8, -149)
           ELSE ((bits & 8388607) + 8388608) * power(2::float8, (bits >> 23 & 255) - 150) END
  FROM homing_int4(bytes, at) AS bits $$;
CREATE FUNCTION homing_float8(bytes bytea, at int) RETURNS double precision
LANGUAGE sql IMMUTABLE AS $$
  SELECT CASE WHEN high >> 31 = 1 THEN -1 ELSE 1 END
         * CASE high >> 20 & 2047 WHEN 0 THEN fraction * power(2::float8, -1074)
           ELSE (fraction + 4503599627370496) * power(2::float8, (high >> 20 & 2047) - 1075) END
  FROM homing_int4(bytes, at) AS high,
       LATERAL (SELECT ((high & 1048575) << 32) + homing_int4(bytes, at + 4)) AS low(fraction) $$;

CREATE VIEW journey_fingerprints AS
  SELECT j.name AS journey, s.step,
         CASE get_byte(fingerprints, at) WHEN 0 THEN 'LEFT' ELSE 'RIGHT' END AS side,
         homing_int4(fingerprints, at + 1) AS landmark,
         homing_float4(fingerprints, at + 5) AS x, homing_float4(fingerprints, at + 9) AS y,
         homing_int4(fingerprints, at + 13) AS count,
         homing_float8(fingerprints, at + 17) AS spread
  FROM journeys j JOIN steps s USING (journey_id),
       LATERAL generate_series(0, length(fingerprints) - 25, 25) AS at;

CREATE VIEW journey_landmarks AS
  SELECT journey, landmark, side, min(step) AS first_step, max(step) AS last_step,
         count(*) AS fingerprint_count, avg(spread) AS spread
  FROM journey_fingerprints GROUP BY journey, landmark, side;
)sql";

// kMigrations[v] migrates from version v to v + 1. A released migration never changes.
struct Migration {
  const char* tables;
  const char* views;
};
constexpr std::array<Migration, kPostgresSchemaVersion> kMigrations = {{{kVersion1, kViews1}}};

// Any number that no other program uses for an advisory lock.
constexpr char kLock[] = "SELECT pg_advisory_xact_lock(1213156681)";

// 0: there are no tables.
absl::StatusOr<std::int64_t> ReadVersion(PgConnection& connection, Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(const PgRows found, connection.Run(kFindVersionTable, {}, deadline));
  if (found.size() == 0 || found.Integer(0, 0) == 0) return 0;
  HOMING_ASSIGN_OR_RETURN(const PgRows version, connection.Run(kReadVersion, {}, deadline));
  if (version.size() == 1) return version.Integer(0, 0);
  return absl::DataLossError("store: the table homing_schema must have one row");
}

absl::Status MigrateInTransaction(PgConnection& connection, Deadline deadline) {
  HOMING_RETURN_IF_ERROR(connection.Execute(kLock, deadline));
  HOMING_ASSIGN_OR_RETURN(const std::int64_t version, ReadVersion(connection, deadline));
  HOMING_RETURN_IF_ERROR(CheckNotNewer(version, kPostgresSchemaVersion));
  for (auto from = static_cast<std::size_t>(version); from < kMigrations.size(); ++from) {
    HOMING_RETURN_IF_ERROR(connection.Execute(kMigrations[from].tables, deadline));
    HOMING_RETURN_IF_ERROR(connection.Execute(kMigrations[from].views, deadline));
  }
  if (version == kPostgresSchemaVersion) return absl::OkStatus();
  return connection.Execute(
      absl::StrCat("UPDATE homing_schema SET version = ", kPostgresSchemaVersion), deadline);
}

}  // namespace

absl::Status CheckSchema(PgConnection& connection, Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(const std::int64_t version, ReadVersion(connection, deadline));
  return CheckSameVersion(version, kPostgresSchemaVersion);
}

absl::Status Migrate(PgConnection& connection, Deadline deadline) {
  HOMING_RETURN_IF_ERROR(connection.Execute("BEGIN", deadline));
  const absl::Status status = MigrateInTransaction(connection, deadline);
  const absl::Status ended = connection.Execute(status.ok() ? "COMMIT" : "ROLLBACK", deadline);
  return status.ok() ? ended : status;
}

}  // namespace homing::storage::postgres
