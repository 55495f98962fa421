#include "server/service/route_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/profile_code.h"
#include "homing/profile/route_scale.h"
#include "proto/wire/enum_conversion.h"
#include "server/base/resource_name.h"

namespace homing::server {
namespace {

constexpr std::int64_t kUsualColumns = 200;
constexpr std::int64_t kMostColumns = 2000;
constexpr std::int64_t kFingerprintBytes = 16;

v1::CameraDirection ToProto(CameraDirection direction) {
  switch (direction) {
    case CameraDirection::kAcross:
      return v1::CAMERA_DIRECTION_ACROSS;
    case CameraDirection::kAlong:
      return v1::CAMERA_DIRECTION_ALONG;
    case CameraDirection::kMixed:
      return v1::CAMERA_DIRECTION_MIXED;
    case CameraDirection::kUnknown:
      break;
  }
  return v1::CAMERA_DIRECTION_UNSPECIFIED;
}

// Median flow length, pixels, with the sign of the median x displacement.
float FlowOf(const OdometerReading& reading) {
  const double octaves =
      (reading.length_code - 1) / OdometerReading::kCodesPerOctave + OdometerReading::kLeastLog2Px;
  const auto px = static_cast<float>(std::exp2(octaves));
  return reading.median_x < 0 ? -px : px;
}

// The mean of the added values; 0 if there are none.
struct Mean {
  double sum = 0;
  int count = 0;
  void Add(double value) {
    sum += value;
    ++count;
  }
  double Value() const { return count == 0 ? 0 : sum / count; }
};

// Adds one column: the means of `profiles`.
void AddColumn(std::span<const FlowProfile> profiles, v1::RouteSide* side) {
  std::array<Mean, FlowProfile::kCells> counts, nearness;
  Mean flow;
  for (const FlowProfile& profile : profiles) {
    if (profile == FlowProfile{}) continue;
    if (profile.odometer.has_value()) flow.Add(FlowOf(profile.odometer));
    for (int cell = 0; cell < FlowProfile::kCells; ++cell) {
      const auto index = static_cast<std::size_t>(cell);
      counts[index].Add(profile.count_code(cell));
      if (profile.parallax_code(cell) > 0) nearness[index].Add(profile.parallax_code(cell));
    }
  }
  side->add_flow_px(static_cast<float>(flow.Value()));
  for (const Mean& mean : counts) {
    side->mutable_counts()->push_back(static_cast<char>(std::lround(mean.Value())));
  }
  for (const Mean& mean : nearness) {
    side->mutable_nearness()->push_back(static_cast<char>(std::lround(mean.Value())));
  }
}

std::int64_t BytesOf(const JourneyMap& map) {
  std::int64_t bytes = kFingerprintBytes * std::ssize(map.all_fingerprints());
  for (const Side side : {Side::kLeft, Side::kRight}) {
    for (const FlowProfile& profile : map.profiles(side)) {
      bytes += profile == FlowProfile{} ? 0 : static_cast<std::int64_t>(kProfileBytes);
    }
  }
  return bytes;
}

}  // namespace

absl::Status FillRouteDescription(const v1::DescribeRouteRequest& request, JourneyCatalog* catalog,
                                  v1::DescribeRouteResponse* response) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request.name(), "name"));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("columns", request.columns(), 0, kMostColumns, "columns"));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("first_step", request.first_step(), 0, kMostSteps, "steps"));
  HOMING_ASSIGN_OR_RETURN(auto journey, catalog->Open(name.ToString()));
  const LiveJourneys one = {std::move(journey)};
  const MapsLock lock(one);
  const JourneyMap& map = one.front()->map();
  const std::int64_t columns = request.columns() == 0 ? kUsualColumns : request.columns();
  const std::int64_t last = request.has_last_step() ? request.last_step() : kMostSteps;
  const std::int64_t end = std::clamp<std::int64_t>(last, -1, map.step_count() - 1) + 1;
  const std::int64_t first = std::min(request.first_step(), end);
  const std::int64_t each = std::max<std::int64_t>(1, (end - first + columns - 1) / columns);
  response->set_steps_each(each);
  response->set_grid_columns(FlowProfile::kColumns);
  response->set_grid_rows(FlowProfile::kRows);
  response->set_map_bytes(BytesOf(map));
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto profiles = map.profiles(side);
    if (profiles.empty()) continue;
    v1::RouteSide* message = response->add_sides();
    message->set_side(wire::ToProto(side));
    message->set_direction(ToProto(CameraOdometer(profiles).direction()));
    for (std::int64_t step = first; step < end; step += each) {
      AddColumn(profiles.subspan(static_cast<std::size_t>(step),
                                 static_cast<std::size_t>(std::min(each, end - step))),
                message);
    }
  }
  return absl::OkStatus();
}

}  // namespace homing::server
