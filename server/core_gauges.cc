#include "server/core_gauges.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "server/config/option_table.h"
#include "server/tls_credentials.h"
#include "storage/database_url.h"

namespace homing::server {
namespace {

namespace fs = std::filesystem;

double SizeOf(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : static_cast<double>(size);
}

double FreeBytes(const std::string& path) {
  std::error_code error;
  const fs::space_info space = fs::space(fs::absolute(path, error).parent_path(), error);
  return error ? 0 : static_cast<double>(space.available);
}

double ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  double resident = 0;
  file >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double OpenFiles() {
  std::error_code error;
  double count = 0;
  for (auto entry = fs::directory_iterator("/proc/self/fd", error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    ++count;
  }
  return count;
}

double FirstEnd(const CertificateFiles& files) {
  const std::vector<CertificateExpiry> expiries = ReadExpiries(files);
  const auto first = std::min_element(
      expiries.begin(), expiries.end(),
      [](const CertificateExpiry& a, const CertificateExpiry& b) { return a.end_s < b.end_s; });
  return first == expiries.end() ? 0 : static_cast<double>(first->end_s);
}

}  // namespace

void AddCoreGauges(const ServerOptions& options, ServiceCore* core) {
  Metrics* const metrics = core->metrics.get();
  const std::string path = storage::ParseDatabaseUrl(options.database).value_or("");
  metrics->AddGauge("homing_ingest_queue_depth", "Observations that wait for their transaction",
                    [core] { return static_cast<double>(core->queue.waiting()); });
  metrics->AddGauge("homing_worker_queue_depth", "Tasks that wait for a worker",
                    [core] { return static_cast<double>(core->pool.waiting()); });
  metrics->AddGauge("homing_open_streams", "Streams that are open",
                    [core] { return static_cast<double>(core->slots.open()); });
  metrics->AddGauge("homing_import_bytes", "Bytes of files that are being imported",
                    [core] { return static_cast<double>(core->import_bytes.load()); });
  metrics->AddGauge("homing_belief_bytes", "Bytes of the beliefs of streams that localise",
                    [core] { return static_cast<double>(core->catalog.beliefs()->used()); });
  metrics->AddGauge("homing_export_bytes", "Bytes of files that are being exported",
                    [core] { return static_cast<double>(core->export_bytes.load()); });
  metrics->AddGauge("homing_journeys_deleted", "Journeys deleted by age or quota since the start",
                    [core] { return static_cast<double>(core->quota.deleted()); });
  metrics->AddGauge("homing_journeys_damaged",
                    "Journeys that wildcards skip because they were found damaged",
                    [core] { return static_cast<double>(core->catalog.damaged()); });
  metrics->AddGauge("homing_robots_lost", "Robots that localise and are off every route",
                    [core] { return static_cast<double>(core->fleet.Count().lost); });
  metrics->AddGauge("homing_robots_localizing", "Robots that localise",
                    [core] { return static_cast<double>(core->fleet.Count().localizing); });
  metrics->AddGauge("homing_robots_recording", "Robots that record",
                    [core] { return static_cast<double>(core->fleet.Count().recording); });
  if (!path.empty()) {
    metrics->AddGauge("homing_db_size_bytes", "The database with its journal",
                      [path] { return SizeOf(path) + SizeOf(path + "-wal"); });
    metrics->AddGauge("homing_disk_free_bytes", "Room left where the database is",
                      [path] { return FreeBytes(path); });
  }
  metrics->AddGauge("process_resident_memory_bytes", "Resident memory", ResidentBytes);
  metrics->AddGauge("process_open_fds", "Open file descriptors", OpenFiles);
  if (!options.tls_cert.empty()) {
    metrics->AddGauge("homing_certificate_end_timestamp_seconds",
                      "When the first certificate or revocation list in use ends, Unix time",
                      [files = CertificateFilesOf(options)] { return FirstEnd(files); });
  }
  ForEachLimit(options, [metrics](const std::string& name, double value) {
    metrics->SetLimit(name, value);
  });
}

}  // namespace homing::server
