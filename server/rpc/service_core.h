// The objects that all handlers share.
#ifndef SERVER_RPC_SERVICE_CORE_H_
#define SERVER_RPC_SERVICE_CORE_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "absl/time/clock.h"
#include "homing/base/mutex.h"
#include "homing/image/frame.h"
#include "proto/wire/observation_conversion.h"
#include "server/access/access_control.h"
#include "server/admission/journey_quota.h"
#include "server/admission/limits.h"
#include "server/admission/rate_limiter.h"
#include "server/admission/stream_limiter.h"
#include "server/base/memory_budget.h"
#include "server/base/request_memory.h"
#include "server/base/worker_pool.h"
#include "server/catalog/fleet_index.h"
#include "server/catalog/journey_catalog.h"
#include "server/catalog/journey_follower.h"
#include "server/catalog/model_catalog.h"
#include "server/fleet/fleet_board.h"
#include "server/metrics/metrics.h"
#include "server/rpc/stream_registry.h"
#include "server/session/recording_session.h"
#include "storage/commit_queue.h"
#include "storage/journey_store.h"

namespace homing::server {

struct CoreOptions {
  // Threads that compute. [1, 1024].
  int workers = 2;
  DecodeLimits decode;
  wire::WireLimits wire;
  CatalogOptions catalog;
  bool all_journeys_index = false;
  Limits limits;
  // Steady time for leases.
  std::function<TimePoint()> clock = [] { return std::chrono::steady_clock::now(); };
};

// Options with a callback that counts and times the commits.
inline storage::CommitQueueOptions QueueOptions(Metrics* metrics) {
  storage::CommitQueueOptions options;
  options.on_commit = [metrics](int stored, bool ok, std::chrono::duration<double> time) {
    metrics->Committed(stored, ok, time.count());
  };
  return options;
}

// The order of destruction is the reverse: first the commit queue, then the store. The workers have
// stopped before.
struct ServiceCore {
  // Most calls whose only request is on its way, in all and of one caller: each takes some KiB.
  static constexpr int kMaxUnread = 4096;
  static constexpr int kMaxUnreadOfCaller = 256;
  // Most streams of one caller that only watch: they leave most of max_streams to robots.
  static constexpr int kMaxWatchesOfCaller = 256;
  // Most tasks of long_work and of archives that wait.
  static constexpr int kMaxLongWork = 16;
  static constexpr int kMaxArchives = 64;
  static constexpr int kStoreWriters = 8;
  static constexpr int kStoreReaders = 4;

  ServiceCore(std::unique_ptr<storage::JourneyStore> opened,
              std::shared_ptr<AccessControl> access_control, const CoreOptions& core_options)
      : options(core_options),
        metrics(std::make_unique<Metrics>()),
        access(std::move(access_control)),
        store(std::move(opened)),
        index(core_options.all_journeys_index ? std::make_unique<FleetIndex>(store.get())
                                              : nullptr),
        catalog(store.get(), core_options.catalog, index.get()),
        follower(store->shared() ? std::make_unique<JourneyFollower>(store.get(), &catalog)
                                 : nullptr),
        models(store.get()),
        quota(&catalog, core_options.limits),
        rates(core_options.limits.max_robot_rate),
        slots(core_options.limits.max_streams, core_options.limits.max_robot_streams),
        queue(store.get(), QueueOptions(metrics.get())),
        pool(core_options.workers),
        large_images(core_options.workers) {}
  ~ServiceCore() {
    archives.Stop();
    store_writes.Stop();
    store_reads.Stop();
    large_images.Stop();
    pool.Stop();
  }
  ServiceCore(const ServiceCore&) = delete;
  ServiceCore& operator=(const ServiceCore&) = delete;

  RecordingContext recording(const DecodeLimits& limits) { return {&catalog, &queue, limits}; }

  const CoreOptions options;
  const std::unique_ptr<Metrics> metrics;
  // Shared with the TLS handshake.
  const std::shared_ptr<AccessControl> access;
  const std::unique_ptr<storage::JourneyStore> store;
  // Null without all_journeys_index.
  const std::unique_ptr<FleetIndex> index;
  // Declared before the catalog, whose writers may hold a place on it.
  FleetBoard fleet{absl::GetCurrentTimeNanos};
  // The stored journeys were counted for the board, beginning then.
  Mutex count_mutex;
  TimePoint counted HOMING_GUARDED_BY(count_mutex);
  JourneyCatalog catalog;
  // Null unless other servers write to the store.
  const std::unique_ptr<JourneyFollower> follower;
  ModelCatalog models;
  JourneyQuota quota;
  RateLimiter rates;
  StreamLimiter slots;
  StreamLimiter unread{kMaxUnread, kMaxUnreadOfCaller};
  StreamLimiter watches{0, kMaxWatchesOfCaller};
  // Bytes of files that are being imported, and exported.
  std::atomic<std::int64_t> import_bytes = 0;
  std::atomic<std::int64_t> export_bytes = 0;
  // Memory of the answers of unary calls that are not sent yet.
  const std::shared_ptr<MemoryBudget> answers =
      std::make_shared<MemoryBudget>(options.limits.memory_quota);
  // Memory of the large requests that wait for a worker.
  const std::shared_ptr<RequestMemory> requests =
      std::make_shared<RequestMemory>(options.limits.memory_quota);
  storage::CommitQueue queue;
  StreamRegistry streams;
  // Runs long tasks, one at a time, so that robots do not wait for them.
  WorkerPool long_work{1, kMaxLongWork};
  // Reads and makes journey files, one at a time: a file needs several times its size meanwhile.
  WorkerPool archives{1, kMaxArchives};
  // For work that waits for the store and computes little: robots do not wait for a database that
  // is away, and this work does not wait for frames. A robot that goes home reads only.
  WorkerPool store_writes{kStoreWriters};
  WorkerPool store_reads{kStoreReaders};
  // For work that computes.
  WorkerPool pool;
  // For images above a megapixel, which take up to seconds. The system shares the processor between
  // these threads and the pool's, so that robots with usual images do not wait for a large one.
  WorkerPool large_images;
};

}  // namespace homing::server

#endif  // SERVER_RPC_SERVICE_CORE_H_
