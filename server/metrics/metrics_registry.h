// The metric families behind Metrics.
#ifndef SERVER_METRICS_METRICS_REGISTRY_H_
#define SERVER_METRICS_METRICS_REGISTRY_H_

#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "homing/base/mutex.h"
#include "server/access/rpc.h"
#include "server/metrics/metrics.h"

namespace homing::server {

// Streams live for minutes, unary calls for milliseconds.
inline const prometheus::Histogram::BucketBoundaries kCallSeconds = {
    0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 60, 600, 3600};
inline const prometheus::Histogram::BucketBoundaries kWorkSeconds = {
    0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10};

// Gauges whose values are read at each scrape. Thread-safe.
class LiveGauges final : public prometheus::Collectable {
 public:
  void Add(const std::string& name, const std::string& help, std::function<double()> value);
  // Returns when no value is being read.
  void Clear();
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  struct Entry {
    std::string name;
    std::string help;
    std::function<double()> read;
  };
  mutable Mutex mutex_;
  std::vector<Entry> entries_ HOMING_GUARDED_BY(mutex_);
};

// Counters of one family that every observation needs: each is looked up by its labels once.
// Thread-safe.
template <std::size_t count>
class KnownCounters {
 public:
  template <typename MakeLabels>
  prometheus::Counter& Of(std::size_t index, prometheus::Family<prometheus::Counter>& family,
                          MakeLabels make_labels) {
    prometheus::Counter* counter = known_[index].load(std::memory_order_acquire);
    if (counter == nullptr) {
      counter = &family.Add(make_labels());
      known_[index].store(counter, std::memory_order_release);
    }
    return *counter;
  }

 private:
  std::array<std::atomic<prometheus::Counter*>, count> known_{};
};

struct Metrics::State {
  std::shared_ptr<prometheus::Registry> registry = std::make_shared<prometheus::Registry>();
  std::shared_ptr<LiveGauges> gauges = std::make_shared<LiveGauges>();

  prometheus::Family<prometheus::Counter>& started;
  prometheus::Family<prometheus::Histogram>& duration;
  prometheus::Family<prometheus::Counter>& errors;
  prometheus::Family<prometheus::Counter>& observations;
  prometheus::Family<prometheus::Counter>& outcomes;
  prometheus::Family<prometheus::Counter>& commits;
  prometheus::Family<prometheus::Gauge>& limits;
  prometheus::Counter& steps;
  prometheus::Histogram& localize_seconds;
  prometheus::Histogram& commit_seconds;
  KnownCounters<kRpcs.size()> observations_of;
  // Indexed by Outcome, which counts from 1.
  KnownCounters<4> outcomes_of;

  State();
};

}  // namespace homing::server

#endif  // SERVER_METRICS_METRICS_REGISTRY_H_
