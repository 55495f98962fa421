#include "server/core_gauges.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "storage/database_url.h"

namespace homing::server {
namespace {

namespace fs = std::filesystem;

double SizeOf(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : static_cast<double>(size);
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

void SetLimits(const ServerOptions& options, Metrics* metrics) {
  const Limits& limits = options.limits;
  const auto set = [metrics](const char* name, auto value) {
    metrics->SetLimit(name, static_cast<double>(value));
  };
  set("max-message", options.max_message);
  set("max-pixels", options.max_pixels);
  set("max-vectors", options.max_vectors);
  set("max-streams", limits.max_streams);
  set("max-robot-streams", limits.max_robot_streams);
  set("max-robot-rate", limits.max_robot_rate);
  set("max-robot-journeys", limits.max_robot_journeys);
  set("max-robot-bytes", limits.max_robot_bytes);
  set("max-database", limits.max_database);
  set("memory-quota", limits.memory_quota);
  set("idle-stream-s", limits.idle_stream_s);
  set("keepalive-s", limits.keepalive_s);
  set("delete-after-s", limits.delete_after_s);
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
                    [core] { return static_cast<double>(core->places.open()); });
  metrics->AddGauge("homing_import_bytes", "Bytes of files that are being imported",
                    [core] { return static_cast<double>(core->import_bytes.load()); });
  metrics->AddGauge("homing_journeys_deleted", "Journeys deleted by age or quota since the start",
                    [core] { return static_cast<double>(core->quota.deleted()); });
  metrics->AddGauge("homing_db_size_bytes", "The database with its journal",
                    [path] { return SizeOf(path) + SizeOf(path + "-wal"); });
  metrics->AddGauge("process_resident_memory_bytes", "Resident memory", ResidentBytes);
  metrics->AddGauge("process_open_fds", "Open file descriptors", OpenFiles);
  SetLimits(options, metrics);
}

}  // namespace homing::server
