// All places draw from one pool of eight textures. The paper's landmarks are textured, so that they
// give much flow (III).
#ifndef CLIENT_SIMULATOR_TEXTURE_POOL_H_
#define CLIENT_SIMULATOR_TEXTURE_POOL_H_

#include <array>
#include <cstdint>
#include <vector>

namespace homing::client {

// A tile that repeats in both directions, with levels of half the size each. Values are in [-1, 1].
// Immutable.
class Texture {
 public:
  static constexpr int kSide = 256;

  // `tones` holds kSide * kSide values, row by row.
  explicit Texture(const std::vector<double>& tones);

  // u and v in tiles, [0, 1]; `level` 0 is the full size. Trilinear.
  float Sample(float u, float v, float level) const;

 private:
  struct Level {
    int side;
    std::vector<std::int8_t> tones;
  };
  static float SampleLevel(const Level& level, float u, float v);

  std::vector<Level> levels_;
};

inline constexpr int kTextureCount = 8;
enum TextureKind {
  kValueNoise,
  kBricks,
  kWindows,
  kPlanks,
  kMosaic,
  kSpots,
  kBands,
  kTiles,
};

using TexturePool = std::array<Texture, kTextureCount>;
// Made once, always the same.
const TexturePool& GetTexturePool();

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_TEXTURE_POOL_H_
