#include "storage/doctor.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "homing/base/status_macros.h"
#include "storage/connection.h"
#include "storage/database_url.h"
#include "storage/journey_rows.h"
#include "storage/journey_store.h"
#include "storage/map_rows.h"
#include "storage/model_rows.h"
#include "storage/postgres_store.h"
#include "storage/schema.h"

namespace homing::storage {
namespace {

constexpr int kMostProblems = 100;

// Each query may end early in a damaged file; together they reach more rows.
constexpr const char* kJourneyNames[] = {
    "SELECT name FROM journeys ORDER BY journey_id",
    "SELECT name FROM journeys ORDER BY journey_id DESC",
    "SELECT name FROM journeys INDEXED BY sqlite_autoindex_journeys_1 ORDER BY name",
    "SELECT name FROM journeys INDEXED BY sqlite_autoindex_journeys_1 ORDER BY name DESC"};
constexpr const char* kModelNames[] = {"SELECT name FROM deviation_models ORDER BY name",
                                       "SELECT name FROM deviation_models ORDER BY name DESC"};

// DATA_LOSS: another form of name. No server writes it, and no request can name it.
absl::Status CheckName(const std::string& name, std::initializer_list<const char*> collections) {
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  std::size_t i = 0;
  bool fits = parts.size() == 2 * collections.size();
  for (const char* const collection : collections) {
    fits = fits && parts[i] == collection && !parts[i + 1].empty();
    i += 2;
  }
  return fits ? absl::OkStatus()
              : absl::DataLossError(absl::StrCat("store: the name '", name, "' is damaged"));
}

// Called for each readable item; its status becomes that of the finding.
struct Savers {
  std::function<absl::Status(const JourneyRecord&, const JourneyMap&)> journey =
      [](const auto&, const auto&) { return absl::OkStatus(); };
  std::function<absl::Status(const StoredModel&)> model = [](const auto&) {
    return absl::OkStatus();
  };
};

class Examination {
 public:
  Examination(Connection* connection, Savers savers)
      : connection_(connection), savers_(std::move(savers)) {}

  absl::StatusOr<Diagnosis> Run() {
    HOMING_RETURN_IF_ERROR(CheckReadable());
    CheckPages();
    for (const std::string& name : Names(kJourneyNames)) {
      if (!absl::StartsWith(name, kHiddenPrefix)) ExamineJourney(name);
    }
    for (const std::string& name : Names(kModelNames)) ExamineModel(name);
    return std::move(diagnosis_);
  }

 private:
  absl::Status CheckReadable() {
    HOMING_RETURN_IF_ERROR(CheckSchema(*connection_));
    return connection_->Run([&] {
      diagnosis_.schema_version = connection_->Integer("PRAGMA user_version");
      return absl::OkStatus();
    });
  }

  void CheckPages() {
    Note(connection_->Run([&] {
      const std::string sql = absl::StrCat("PRAGMA integrity_check(", kMostProblems, ")");
      SQLite::Statement check(connection_->database(), sql);
      while (check.executeStep()) {
        const std::string line = check.getColumn(0).getString();
        if (line != "ok") diagnosis_.problems.push_back(line);
      }
      return absl::OkStatus();
    }));
  }

  template <std::size_t kQueries>
  std::set<std::string> Names(const char* const (&queries)[kQueries]) {
    std::set<std::string> names;
    for (const char* sql : queries) {
      Note(connection_->Run([&] {
        Query query = connection_->Prepare(sql);
        while (query.Next()) names.insert(query.Text(0));
        return absl::OkStatus();
      }));
    }
    return names;
  }

  void ExamineJourney(const std::string& name) {
    Finding finding{name, 0, absl::OkStatus()};
    finding.status = connection_->Read([&]() -> absl::Status {
      HOMING_RETURN_IF_ERROR(CheckName(name, {"robots", "journeys"}));
      HOMING_ASSIGN_OR_RETURN(const JourneyRow row, FindJourney(*connection_, name));
      HOMING_ASSIGN_OR_RETURN(const JourneyMap map, ReadMap(*connection_, row));
      finding.step_count = map.step_count();
      return savers_.journey(row.record, map);
    });
    diagnosis_.journeys.push_back(std::move(finding));
  }

  void ExamineModel(const std::string& name) {
    Finding finding{name, 0, absl::OkStatus()};
    finding.status = connection_->Read([&]() -> absl::Status {
      HOMING_RETURN_IF_ERROR(CheckName(name, {"deviationModels"}));
      HOMING_ASSIGN_OR_RETURN(const StoredModel model, FindModel(*connection_, name));
      return savers_.model(model);
    });
    diagnosis_.models.push_back(std::move(finding));
  }

  void Note(const absl::Status& status) {
    const std::string problem(status.message());
    const auto& known = diagnosis_.problems;
    if (status.ok() || std::find(known.begin(), known.end(), problem) != known.end()) return;
    diagnosis_.problems.push_back(problem);
  }

  Connection* const connection_;
  const Savers savers_;
  Diagnosis diagnosis_;
};

absl::StatusOr<Diagnosis> ExamineWith(const std::string& path, Savers savers) {
  HOMING_ASSIGN_OR_RETURN(const auto connection, OpenForReading(path, kBusyTimeoutMs));
  return Examination(connection.get(), std::move(savers)).Run();
}

// A new store, of this program's schema.
absl::StatusOr<std::unique_ptr<Connection>> MakeStore(const std::string& path) {
  if (std::filesystem::exists(path)) {
    return absl::AlreadyExistsError(absl::StrCat("'", path, "' exists; name a new file"));
  }
  StoreOptions options;
  options.url = absl::StrCat("sqlite:", path);
  HOMING_RETURN_IF_ERROR(OpenJourneyStore(options).status());
  return Connection::Open(path, Connection::Access::kReadWrite, kBusyTimeoutMs);
}

absl::Status SaveJourney(Connection& connection, const JourneyRecord& record,
                         const JourneyMap& map) {
  return connection.Write([&]() -> absl::Status {
    HOMING_ASSIGN_OR_RETURN(const std::int64_t id, InsertJourney(connection, record));
    WriteMap(connection, id, map);
    return absl::OkStatus();
  });
}

// Examines a PostgreSQL store, which other servers may be using.
absl::StatusOr<Diagnosis> ExamineShared(const std::string& url) {
  StoreOptions options;
  options.url = url;
  options.read_only = true;
  HOMING_ASSIGN_OR_RETURN(const auto store, OpenJourneyStore(options));
  Diagnosis diagnosis;
  diagnosis.schema_version = kPostgresSchemaVersion;
  constexpr int kPage = 100;
  for (std::string after, last = "-"; last != after;) {
    last = after;
    HOMING_ASSIGN_OR_RETURN(const auto page, store->ListJourneys("", after, kPage));
    for (const JourneyRecord& record : page) {
      const auto map = store->LoadMap(record.name);
      // The journey was deleted meanwhile.
      if (absl::IsNotFound(map.status())) continue;
      diagnosis.journeys.push_back({record.name, map.ok() ? map->step_count() : 0, map.status()});
    }
    if (!page.empty()) after = page.back().name;
  }
  HOMING_ASSIGN_OR_RETURN(const auto models, store->ListModels("", 1'000'000));
  for (const StoredModel& model : models) {
    diagnosis.models.push_back({model.name, 0, absl::OkStatus()});
  }
  return diagnosis;
}

}  // namespace

int CountDamaged(const std::vector<Finding>& findings) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [](const auto& f) { return !f.status.ok(); }));
}

bool IsWhole(const Diagnosis& diagnosis) {
  return diagnosis.problems.empty() && CountDamaged(diagnosis.journeys) == 0 &&
         CountDamaged(diagnosis.models) == 0;
}

absl::StatusOr<Diagnosis> Examine(const std::string& path) {
  return IsPostgresUrl(path) ? ExamineShared(path) : ExamineWith(path, {});
}

absl::StatusOr<Diagnosis> Salvage(const std::string& path, const std::string& to) {
  if (IsPostgresUrl(path)) {
    return absl::InvalidArgumentError(
        "--salvage works on SQLite files only; restore a backup of PostgreSQL");
  }
  // Read first, so that no file is created when nothing can be read.
  HOMING_RETURN_IF_ERROR(OpenForReading(path, kBusyTimeoutMs).status());
  HOMING_ASSIGN_OR_RETURN(const auto saved, MakeStore(to));
  Savers savers;
  savers.journey = [&saved](const JourneyRecord& record, const JourneyMap& map) {
    return SaveJourney(*saved, record, map);
  };
  savers.model = [&saved](const StoredModel& model) {
    return saved->Write([&] { return InsertModel(*saved, model); });
  };
  return ExamineWith(path, std::move(savers));
}

}  // namespace homing::storage
