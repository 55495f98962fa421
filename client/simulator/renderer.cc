#include "client/simulator/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "client/simulator/texture_pool.h"

namespace homing::client {
namespace {

constexpr int kWidth = Simulator::kWidth;
constexpr int kHeight = Simulator::kHeight;
constexpr auto kRow = static_cast<std::size_t>(kWidth);

// Place on a texture, in tiles, [0, 1].
struct TilePlace {
  float u = 0;
  float v = 0;
};

// Within its tile; in double, so that the hundredth kilometre is as sharp as the first.
float InTile(double tiles) {
  const double past = tiles - static_cast<double>(static_cast<std::int64_t>(tiles));
  return static_cast<float>(past < 0 ? past + 1 : past);
}

TilePlace PlaceOn(const ViewedSurface& surface, const Ray& ray, double depth) {
  const Vector2 metres =
      std::visit([&](const auto& s) { return s.Texture(ray, depth); }, surface.shape);
  const Material& material = *surface.material;
  return {InTile(metres[0] / material.tile_m + material.offset[0]),
          InTile(metres[1] / material.tile_m + material.offset[1])};
}

// The shorter way between two places of one tile that repeats.
float Shortest(float step) { return step > 0.5F ? step - 1 : (step < -0.5F ? step + 1 : step); }

// Squared distance in tiles.
float SquaredStep(const TilePlace& a, const TilePlace& b) {
  const float du = Shortest(a.u - b.u);
  const float dv = Shortest(a.v - b.v);
  return du * du + dv * dv;
}

class BrightnessRenderer {
 public:
  BrightnessRenderer(const View& view, const SurfaceMap& map)
      : view_(view),
        map_(map),
        textures_(GetTexturePool()),
        places_(kPixelCount),
        levels_(kPixelCount),
        brightness_(kPixelCount, static_cast<float>(view.sky_grey())) {}

  std::vector<float> Render() {
    FindPlaces();
    ForEachPixel([&](int x, int y, std::size_t pixel) {
      if (map_.surfaces[pixel] != kSky) {
        levels_[pixel] = Level(x, y, pixel);
        brightness_[pixel] = Shade(SurfaceAt(pixel), places_[pixel], levels_[pixel]);
      }
    });
    ForEachPixel([&](int x, int y, std::size_t pixel) {
      if (IsEdge(x, y, pixel)) {
        brightness_[pixel] = Supersample(x, y, pixel);
      }
    });
    return std::move(brightness_);
  }

 private:
  template <typename Action>
  static void ForEachPixel(const Action& action) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        action(x, y, static_cast<std::size_t>(y) * kRow + static_cast<std::size_t>(x));
      }
    }
  }

  const ViewedSurface& SurfaceAt(std::size_t pixel) const {
    return view_.surfaces()[static_cast<std::size_t>(map_.surfaces[pixel])];
  }

  void FindPlaces() {
    ForEachPixel([&](int x, int y, std::size_t pixel) {
      if (map_.surfaces[pixel] != kSky) {
        places_[pixel] = PlaceOn(SurfaceAt(pixel), view_.rays().At(x, y), map_.depths[pixel]);
      }
    });
  }

  // Squared step of the texture to a neighbour of the same surface, on either side.
  float StepTo(std::size_t pixel, bool has_next, std::size_t next, bool has_last,
               std::size_t last) const {
    if (has_next && map_.surfaces[next] == map_.surfaces[pixel]) {
      return SquaredStep(places_[pixel], places_[next]);
    }
    if (has_last && map_.surfaces[last] == map_.surfaces[pixel]) {
      return SquaredStep(places_[pixel], places_[last]);
    }
    return 0;
  }

  // Level at which a texel is as large as the pixel.
  float Level(int x, int y, std::size_t pixel) const {
    const float across = StepTo(pixel, x + 1 < kWidth, pixel + 1, x > 0, pixel - 1);
    const float down = StepTo(pixel, y + 1 < kHeight, pixel + kRow, y > 0, pixel - kRow);
    const float texels = std::max(across, down) * (Texture::kSide * Texture::kSide);
    return texels <= 1 ? 0 : 0.5F * std::log2(texels);
  }

  float Shade(const ViewedSurface& surface, const TilePlace& place, float level) const {
    const Material& material = *surface.material;
    const Texture& texture = textures_[static_cast<std::size_t>(material.texture)];
    return static_cast<float>(material.mean) +
           static_cast<float>(material.contrast) * texture.Sample(place.u, place.v, level);
  }

  std::array<std::size_t, 5> Cross(int x, int y, std::size_t pixel) const {
    return {pixel, x > 0 ? pixel - 1 : pixel, x + 1 < kWidth ? pixel + 1 : pixel,
            y > 0 ? pixel - kRow : pixel, y + 1 < kHeight ? pixel + kRow : pixel};
  }

  bool IsEdge(int x, int y, std::size_t pixel) const {
    const auto cross = Cross(x, y, pixel);
    return std::any_of(cross.begin() + 1, cross.end(), [&](std::size_t neighbour) {
      return map_.surfaces[neighbour] != map_.surfaces[pixel];
    });
  }

  // The rays of a pixel can only hit the surfaces that it or its neighbours show.
  float Supersample(int x, int y, std::size_t pixel) const {
    const auto cross = Cross(x, y, pixel);
    float sum = 0;
    for (const double dy : {-0.25, 0.25}) {
      for (const double dx : {-0.25, 0.25}) {
        sum += ShadeRay(view_.rays().At(x + dx, y + dy), cross);
      }
    }
    return 0.25F * sum;
  }

  float ShadeRay(const Ray& ray, const std::array<std::size_t, 5>& pixels) const {
    double nearest = kNothing;
    std::size_t nearest_pixel = kPixelCount;
    for (const std::size_t pixel : pixels) {
      if (map_.surfaces[pixel] == kSky) {
        continue;
      }
      const double depth = DepthOf(SurfaceAt(pixel), ray);
      if (depth < nearest) {
        nearest = depth;
        nearest_pixel = pixel;
      }
    }
    if (nearest_pixel == kPixelCount) {
      return static_cast<float>(view_.sky_grey());
    }
    const ViewedSurface& surface = SurfaceAt(nearest_pixel);
    return Shade(surface, PlaceOn(surface, ray, nearest), levels_[nearest_pixel]);
  }

  const View& view_;
  const SurfaceMap& map_;
  const TexturePool& textures_;
  std::vector<TilePlace> places_;
  std::vector<float> levels_;
  std::vector<float> brightness_;
};

}  // namespace

std::vector<float> RenderBrightness(const View& view, const SurfaceMap& map) {
  return BrightnessRenderer(view, map).Render();
}

}  // namespace homing::client
