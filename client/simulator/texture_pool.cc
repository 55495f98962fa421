#include "client/simulator/texture_pool.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

// A constant, so that the pool is the same in every world.
constexpr std::uint64_t kPoolSeed = 20090817;

double Tone(std::uint64_t stream, int x, int y) {
  return ToUnit(
      Mix(kPoolSeed ^ stream, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)));
}

int Wrapped(int index, int count) { return ((index % count) + count) % count; }

// Smooth noise over a lattice of count x count points that repeats.
double ValueNoise(std::uint64_t stream, double u, double v, int count) {
  const double x = u * count;
  const double y = v * count;
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double a = smooth(x - x0);
  const double b = smooth(y - y0);
  const auto lattice = [&](int i, int k) {
    return Tone(stream, Wrapped(i, count), Wrapped(k, count));
  };
  return (1 - b) * ((1 - a) * lattice(x0, y0) + a * lattice(x0 + 1, y0)) +
         b * ((1 - a) * lattice(x0, y0 + 1) + a * lattice(x0 + 1, y0 + 1));
}

double Grain(std::uint64_t stream, double u, double v) {
  return 0.6 * ValueNoise(stream, u, v, 24) + 0.4 * ValueNoise(stream + 1, u, v, 64);
}

double Clouds(double u, double v) {
  return 0.5 * ValueNoise(100, u, v, 10) + 0.3 * ValueNoise(101, u, v, 23) +
         0.35 * ValueNoise(102, u, v, 47);
}

double Bricks(double u, double v) {
  const int row = static_cast<int>(v * 12);
  const double x = u * 6 + 0.5 * (row % 2);
  const int column = Wrapped(static_cast<int>(x), 6);
  const bool joint = x - std::floor(x) < 0.07 || v * 12 - row < 0.14;
  return joint ? 0.95 : 0.15 + 0.5 * Tone(200, column, row) + 0.15 * Grain(201, u, v);
}

double Windows(double u, double v) {
  const double x = u * 3 - std::floor(u * 3);
  const double y = v * 3 - std::floor(v * 3);
  const int column = static_cast<int>(u * 3);
  const int row = static_cast<int>(v * 3);
  if (x < 0.22 || x > 0.78 || y < 0.15 || y > 0.8) {
    return 0.6 + 0.25 * Grain(300, u, v);
  }
  const bool frame = x < 0.27 || x > 0.73 || y < 0.2 || y > 0.75 || std::abs(x - 0.5) < 0.02;
  return frame ? 1.0 : 0.05 + 0.35 * Tone(302, column * 2 + (x > 0.5 ? 1 : 0), row);
}

double Planks(double u, double v) {
  const int column = static_cast<int>(u * 11);
  const double length = v * 2 + Tone(400, column, 0);
  const int piece = Wrapped(static_cast<int>(length), 2);
  const bool gap = u * 11 - column < 0.1 || length - std::floor(length) < 0.03;
  return gap ? 0.0 : 0.3 + 0.5 * Tone(401, column, piece) + 0.3 * Grain(402, u, v);
}

// The tone of the nearest of count x count jittered points, or the distance to it.
struct Nearest {
  double tone = 0;
  double distance = 9;
};
Nearest NearestPoint(std::uint64_t stream, double u, double v, int count) {
  const int cx = static_cast<int>(u * count);
  const int cy = static_cast<int>(v * count);
  Nearest nearest;
  for (int y = cy - 1; y <= cy + 1; ++y) {
    for (int x = cx - 1; x <= cx + 1; ++x) {
      const int wx = Wrapped(x, count);
      const int wy = Wrapped(y, count);
      const double distance = std::hypot(x + Tone(stream, wx, wy) - u * count,
                                         y + Tone(stream + 1, wx, wy) - v * count);
      if (distance < nearest.distance) {
        nearest = {Tone(stream + 2, wx, wy), distance};
      }
    }
  }
  return nearest;
}

double Mosaic(double u, double v) { return NearestPoint(500, u, v, 13).tone; }

double Spots(double u, double v) {
  const Nearest nearest = NearestPoint(600, u, v, 9);
  return nearest.distance < 0.2 + 0.25 * nearest.tone ? nearest.tone * 0.4
                                                      : 0.7 + 0.3 * Grain(603, u, v);
}

double Bands(double u, double v) {
  const double bent = v * 9 + 1.2 * ValueNoise(700, u, v, 6);
  const int band = Wrapped(static_cast<int>(bent), 9);
  return 0.7 * Tone(701, band, 0) + 0.5 * Grain(702, u, v);
}

double Tiles(double u, double v) {
  const int column = static_cast<int>(u * 8);
  const int row = static_cast<int>(v * 8);
  return ((column + row) % 2 == 0 ? 0.2 : 0.65) + 0.35 * Tone(800, column, row);
}

// Mean 0, standard deviation 0.5, bounded by [-1, 1].
std::vector<double> Normalized(std::vector<double> tones) {
  double sum = 0;
  double squares = 0;
  for (const double tone : tones) {
    sum += tone;
    squares += tone * tone;
  }
  const auto count = static_cast<double>(tones.size());
  const double mean = sum / count;
  const double deviation = std::sqrt(squares / count - mean * mean);
  for (double& tone : tones) {
    tone = std::clamp(0.5 * (tone - mean) / deviation, -1.0, 1.0);
  }
  return tones;
}

Texture MakeTexture(double (*tone)(double, double)) {
  std::vector<double> tones;
  tones.reserve(static_cast<std::size_t>(Texture::kSide) * Texture::kSide);
  for (int y = 0; y < Texture::kSide; ++y) {
    for (int x = 0; x < Texture::kSide; ++x) {
      tones.push_back(tone((x + 0.5) / Texture::kSide, (y + 0.5) / Texture::kSide));
    }
  }
  return Texture(Normalized(std::move(tones)));
}

}  // namespace

const TexturePool& GetTexturePool() {
  static const TexturePool pool = {MakeTexture(Clouds), MakeTexture(Bricks), MakeTexture(Windows),
                                   MakeTexture(Planks), MakeTexture(Mosaic), MakeTexture(Spots),
                                   MakeTexture(Bands),  MakeTexture(Tiles)};
  return pool;
}

}  // namespace homing::client
