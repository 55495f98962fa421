// A measurement of a map, kept with the map so that robots that share it measure it only once.
#ifndef HOMING_JOURNEY_MEASURED_ROUTE_H_
#define HOMING_JOURNEY_MEASURED_ROUTE_H_

#include <memory>
#include <mutex>
#include <utility>

namespace homing {

struct RouteScale;

// Thread-safe: robots that share a map measure it at the same time. A copied or moved map
// keeps it.
class MeasuredRoute {
 public:
  MeasuredRoute() = default;
  ~MeasuredRoute() = default;
  MeasuredRoute(const MeasuredRoute& other) : scale_(other.get()) {}
  MeasuredRoute(MeasuredRoute&& other) noexcept : scale_(other.get()) {}
  MeasuredRoute& operator=(const MeasuredRoute& other) {
    if (this != &other) set(other.get());
    return *this;
  }
  MeasuredRoute& operator=(MeasuredRoute&& other) noexcept { return *this = std::as_const(other); }

  // Null: not measured yet.
  std::shared_ptr<const RouteScale> get() const {
    const std::lock_guard lock(mutex_);
    return scale_;
  }
  void set(std::shared_ptr<const RouteScale> scale) {
    const std::lock_guard lock(mutex_);
    scale_ = std::move(scale);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const RouteScale> scale_;
};

}  // namespace homing

#endif  // HOMING_JOURNEY_MEASURED_ROUTE_H_
