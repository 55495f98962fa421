#include "server/service/large_images.h"

#include "homing/image/header_pixels.h"
#include "proto/wire/observation_conversion.h"

namespace homing::server {
namespace {

constexpr std::int64_t kUsualPixels = 1 << 20;

bool IsLarge(const v1::Frame& message) {
  const auto frame = wire::FromProto(message, "frame", {});
  return frame.ok() && HeaderPixels(*frame).value_or(kUsualPixels + 1) > kUsualPixels;
}

bool HasLarge(const v1::FramePair& pair) { return IsLarge(pair.first()) || IsLarge(pair.second()); }

}  // namespace

bool HasLargeImage(const v1::Observation& observation) {
  return (observation.left().has_frame() && IsLarge(observation.left().frame())) ||
         (observation.right().has_frame() && IsLarge(observation.right().frame()));
}

bool HasLargeImage(const v1::MatchLandmarksRequest& request) {
  return (request.left().has_frames() && HasLarge(request.left().frames())) ||
         (request.right().has_frames() && HasLarge(request.right().frames()));
}

}  // namespace homing::server
