#include "server/config/store_commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <vector>

#include "storage/backup.h"
#include "storage/database_url.h"
#include "storage/doctor.h"

namespace homing::server {
namespace {

// The commands accept a plain path, too.
std::string PathOf(const std::string& url) { return storage::ParseDatabaseUrl(url).value_or(url); }

int ReportFailure(const absl::Status& status) {
  std::cerr << "homing-server: " << std::string(status.message()) << '\n';
  return 1;
}

void ReportFinding(const std::string& kind, const storage::Finding& finding) {
  std::cout << kind << ' ' << finding.name << ": ";
  if (finding.status.ok()) {
    std::cout << "whole";
  } else {
    std::cout << "DAMAGED: " << std::string(finding.status.message());
  }
  std::cout << '\n';
}

void ReportDiagnosis(const std::string& path, const storage::Diagnosis& diagnosis) {
  // The URL of a server may hold a password.
  std::cout << (storage::IsPostgresUrl(path) ? "postgresql" : path) << ": schema version "
            << diagnosis.schema_version << '\n';
  for (const std::string& problem : diagnosis.problems) {
    std::cout << "problem: " << problem << '\n';
  }
  for (const storage::Finding& journey : diagnosis.journeys) ReportFinding("journey", journey);
  for (const storage::Finding& model : diagnosis.models) ReportFinding("model", model);
  std::cout << diagnosis.journeys.size() << " journeys, " << CountDamaged(diagnosis.journeys)
            << " damaged; " << diagnosis.models.size() << " models, "
            << CountDamaged(diagnosis.models) << " damaged; "
            << (IsWhole(diagnosis) ? "the file is whole" : "the file is DAMAGED") << '\n';
}

}  // namespace

StoreCommands::StoreCommands(CLI::App* app, ServerCommand* command)
    : doctor_(app->add_subcommand("doctor", "Check a database; exit 0 if it is undamaged")),
      backup_(app->add_subcommand("backup", "Copy a database; a server may be using it")) {
  doctor_->fallthrough();
  doctor_->add_option("file", command->store_path, "By default that of --database");
  doctor_->add_option("--salvage", command->target_path,
                      "New file: write the undamaged journeys and models into it");
  backup_->fallthrough();
  backup_->add_option("to", command->target_path, "New file")->required();
}

bool StoreCommands::Choose(ServerCommand* command) const {
  if (!doctor_->parsed() && !backup_->parsed()) return false;
  command->action =
      doctor_->parsed() ? ServerCommand::Action::kDoctor : ServerCommand::Action::kBackup;
  const bool named = !command->store_path.empty();
  command->store_path = PathOf(named ? command->store_path : command->options.database);
  return true;
}

int RunDoctor(const std::string& path, const std::string& salvage_to) {
  const auto diagnosis =
      salvage_to.empty() ? storage::Examine(path) : storage::Salvage(path, salvage_to);
  if (!diagnosis.ok()) return ReportFailure(diagnosis.status());
  ReportDiagnosis(path, *diagnosis);
  if (!salvage_to.empty())
    std::cout << "the undamaged journeys and models are in " << salvage_to << '\n';
  return IsWhole(*diagnosis) ? 0 : 1;
}

int RunBackup(const std::string& path, const std::string& to) {
  if (storage::IsPostgresUrl(path)) {
    return ReportFailure(absl::InvalidArgumentError(
        "backup copies SQLite files; copy PostgreSQL with pg_dump or pg_basebackup"));
  }
  const absl::Status status = storage::BackUp(path, to);
  if (!status.ok()) return ReportFailure(status);
  std::error_code ignored;
  std::cout << "backed up " << path << " to " << to << ", "
            << std::filesystem::file_size(to, ignored) << " bytes\n";
  return 0;
}

}  // namespace homing::server
