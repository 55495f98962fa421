// A store whose commits are counted and timed. Source: own design.
#ifndef SERVER_METRICS_METERED_STORE_H_
#define SERVER_METRICS_METERED_STORE_H_

#include <memory>

#include "server/metrics/metrics.h"
#include "storage/journey_store.h"

namespace homing::server {

// As `store` in all else. `metrics` must outlive it.
std::unique_ptr<storage::JourneyStore> Metered(std::unique_ptr<storage::JourneyStore> store,
                                               Metrics* metrics);

}  // namespace homing::server

#endif  // SERVER_METRICS_METERED_STORE_H_
