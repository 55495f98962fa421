#include "client/bench/projected_drive.h"

#include <algorithm>
#include <cmath>

#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kFocalPx = 277;
// One corner a cell, as the tracker keeps.
constexpr int kCellPx = 8;
constexpr int kColumns = kWidth / kCellPx;
constexpr int kRows = kHeight / kCellPx;
// Corners are projected up to this distance from the image centre, in metres along the route for
// each metre of depth.
constexpr double kHalfView = 0.5 * kWidth / kFocalPx;
constexpr int kPatterns = 8;
constexpr double kPatternWidthM = 4;

struct Mark {
  double along = 0;
  double up = 0;
};

// Corners of a façade of 4 m, equal in all worlds.
std::vector<Mark> PatternOf(int pattern) {
  SeededRandom random(Mix(0xF407, static_cast<std::uint64_t>(pattern)));
  std::vector<Mark> marks;
  const int windows = 1 + random.Below(3);
  for (int i = 0; i < windows; ++i) {
    const double left = random.Uniform(0.1, 3.0);
    const double low = random.Uniform(-1.0, 2.0);
    const double width = random.Uniform(0.4, 1.2);
    const double height = random.Uniform(0.5, 1.6);
    for (const double x : {left, left + width / 2, left + width}) {
      for (const double y : {low, low + height / 2, low + height}) marks.push_back({x, y});
    }
  }
  const int loose = 15 + random.Below(25);
  for (int i = 0; i < loose; ++i) {
    marks.push_back({random.Uniform(0, kPatternWidthM), random.Uniform(-1.4, 4.0)});
  }
  return marks;
}

bool Inside(double x, double y) { return x >= 0 && x < kWidth - 1 && y >= 0 && y < kHeight - 1; }

}  // namespace

ProjectedWorld::ProjectedWorld(std::uint64_t seed, double length_m) {
  for (std::size_t side = 0; side < 2; ++side) {
    const std::uint64_t key = Mix(seed, side);
    SeededRandom random(key);
    for (double at = -30; at < length_m + 30;) {
      const double end = at + random.Uniform(5, 18);
      AddFront(side, at, end, random.Bits());
      at = end + (random.Chance(0.3) ? random.Uniform(1, 6) : 0);
    }
    AddRest(side, length_m, Mix(key, 77));
    std::ranges::stable_sort(corners_[side], {}, &Corner::along);
  }
}

void ProjectedWorld::AddFront(std::size_t side, double begin, double end, std::uint64_t key) {
  SeededRandom random(key);
  const double away = random.Uniform(5, 11);
  const double shift = random.Uniform(-0.5, 0.5);
  const std::vector<Mark> pattern = PatternOf(random.Below(kPatterns));
  for (double at = begin; at < end; at += kPatternWidthM) {
    for (const Mark& mark : pattern) {
      if (at + mark.along < end) {
        corners_[side].push_back({static_cast<float>(at + mark.along), static_cast<float>(away),
                                  static_cast<float>(mark.up + shift), -1});
      }
    }
  }
}

// Posts and parked boxes before the façades, trees and roofs behind.
void ProjectedWorld::AddRest(std::size_t side, double length_m, std::uint64_t key) {
  SeededRandom random(key);
  for (double at = -30; at < length_m + 30; at += random.Uniform(2, 9)) {
    const bool far = random.Chance(0.3);
    const double away = far ? random.Uniform(20, 50) : random.Uniform(2.5, 4.5);
    const double width = far ? random.Uniform(3, 10) : random.Uniform(0.1, 2.5);
    const double low = far ? 3 : -1.3;
    const double high = far ? random.Uniform(5, 15) : random.Uniform(-0.5, 1.8);
    const int corners = 6 + random.Below(20);
    const std::int32_t object = objects_++;
    for (int i = 0; i < corners; ++i) {
      corners_[side].push_back({static_cast<float>(at + random.Uniform(0, width)),
                                static_cast<float>(away),
                                static_cast<float>(random.Uniform(low, high)), object});
    }
  }
}

ProjectedDrive::ProjectedDrive(const ProjectedWorld* world, const ProjectedDriveOptions& options)
    : world_(world), options_(options), step_m_(options.speed_kmh / 3.6 / options.fps) {
  size_ = static_cast<std::int64_t>(std::abs(options.end_m - options.start_m) / step_m_);
  if (options.end_m < options.start_m) step_m_ = -step_m_;
}

double ProjectedDrive::Place(std::int64_t instant) const {
  return options_.start_m + (static_cast<double>(instant) + 0.5) * step_m_;
}

bool ProjectedDrive::IsGone(const ProjectedWorld::Corner& corner) const {
  const auto object = static_cast<std::uint64_t>(corner.object);
  return corner.object >= 0 && ToUnit(Mix(options_.seed, 991, object)) < options_.removed;
}

FlowField ProjectedDrive::Field(std::size_t side, std::int64_t instant) const {
  SeededRandom random(Mix(options_.seed, side, static_cast<std::uint64_t>(instant)));
  FlowField field{.width = kWidth, .height = kHeight, .vectors = {}};
  // The direction of the route points to the right of a left image, and to the left of a right one.
  const double sign = side == 0 ? 1 : -1;
  const double before = options_.start_m + static_cast<double>(instant) * step_m_;
  const double now = before + step_m_;
  const auto& corners = world_->corners(side);
  std::array<bool, std::size_t{kColumns} * kRows> taken{};
  const auto from = std::ranges::lower_bound(corners, static_cast<float>(now - 50 * kHalfView), {},
                                             &ProjectedWorld::Corner::along);
  for (auto corner = from; corner != corners.end() && corner->along < now + 50 * kHalfView;
       ++corner) {
    const double away = corner->away - sign * options_.offset_m;
    const double scale = kFocalPx / away;
    const double y = 0.5 * kHeight - scale * corner->up;
    const double start = 0.5 * kWidth + sign * scale * (corner->along - before);
    const double end = 0.5 * kWidth + sign * scale * (corner->along - now);
    if (!Inside(start, y) || !Inside(end, y)) continue;
    if (IsGone(*corner) || random.Chance(options_.missing)) continue;
    const int place = static_cast<int>(y) / kCellPx * kColumns + static_cast<int>(start) / kCellPx;
    bool& cell = taken[static_cast<std::size_t>(place)];
    if (cell) continue;
    cell = true;
    const auto noisy = [&](double value) {
      return static_cast<float>(value + options_.noise_px * random.Gaussian());
    };
    field.vectors.push_back({noisy(start), noisy(y), noisy(end), noisy(y)});
  }
  const auto clutter = std::lround(options_.clutter * static_cast<double>(field.vectors.size()));
  for (long i = 0; i < clutter; ++i) {
    const double x = random.Uniform(10, kWidth - 10);
    const double y = random.Uniform(10, kHeight - 10);
    field.vectors.push_back({static_cast<float>(x), static_cast<float>(y),
                             static_cast<float>(x + random.Uniform(-9, 9)),
                             static_cast<float>(y + random.Uniform(-2, 2))});
  }
  return field;
}

ObservedFlow ProjectedDrive::Flow(std::int64_t instant) const {
  ObservedFlow flow;
  for (std::size_t side = 0; side < 2; ++side) {
    // The camera that looks at this side now.
    const std::size_t camera = options_.travel == Travel::kSame ? side : 1 - side;
    flow.fields[camera] = Field(side, instant);
  }
  return flow;
}

}  // namespace homing::client
