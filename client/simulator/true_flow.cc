#include "client/simulator/true_flow.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace homing::client {
namespace {

// Relative: a point this little behind the nearest surface is on it.
constexpr double kDepthTolerance = 1e-6;

// Camera coordinates in `to` of what `from` sees on a ray; a direction if infinitely far.
Vector3 Moved(const View& from, const View& to, const Ray& ray, double depth) {
  const Vector3 along(ray.x, ray.y, 1);
  if (depth >= kFarAway) {
    return to.camera().Turned(from.camera().TurnedBack(along));
  }
  return to.camera().FromWorld(from.camera().ToWorld(depth * along));
}

std::optional<cv::Vec2d> PixelIn(const View& to, const Vector3& point, bool is_far) {
  if (point[2] < kNearest) {
    return std::nullopt;
  }
  const Ray ray{point[0] / point[2], point[1] / point[2]};
  const Ray seen = to.rays().Untilted(ray);
  const cv::Vec2d pixel(seen.x * Simulator::kFocal + Simulator::kCenterX,
                        seen.y * Simulator::kFocal + Simulator::kCenterY);
  const bool inside = pixel[0] >= 0 && pixel[0] <= Simulator::kWidth - 1 && pixel[1] >= 0 &&
                      pixel[1] <= Simulator::kHeight - 1;
  const double depth = is_far ? kFarAway : point[2];
  if (!inside || to.NearestDepth(ray) < depth * (1 - kDepthTolerance)) {
    return std::nullopt;
  }
  return pixel;
}

}  // namespace

cv::Mat FlowBetween(const View& from, const View& to) {
  const SurfaceMap map = from.Cast();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  cv::Mat flow(Simulator::kHeight, Simulator::kWidth, CV_32FC2, cv::Scalar::all(nan));
  for (int y = 0; y < Simulator::kHeight; ++y) {
    for (int x = 0; x < Simulator::kWidth; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * Simulator::kWidth + static_cast<std::size_t>(x);
      if (map.surfaces[i] == kSky) {
        continue;
      }
      const Vector3 point = Moved(from, to, from.rays().At(x, y), map.depths[i]);
      if (const auto pixel = PixelIn(to, point, map.depths[i] >= kFarAway)) {
        flow.at<cv::Vec2f>(y, x) =
            cv::Vec2f(static_cast<float>((*pixel)[0] - x), static_cast<float>((*pixel)[1] - y));
      }
    }
  }
  return flow;
}

}  // namespace homing::client
