#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace cmap {

/// Bits that look random, of up to three integers and a seed.
inline std::uint32_t mix_bits(std::uint32_t h) {
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12;
  h *= 0x297a2d39U;
  return h ^ (h >> 15);
}
inline std::uint32_t hash_cell(int x, int y, int z, std::uint32_t seed) {
  return mix_bits(static_cast<std::uint32_t>(x) * 0x8da6b343U ^ static_cast<std::uint32_t>(y) * 0xd8163841U ^
                  static_cast<std::uint32_t>(z) * 0xcb1ab31fU ^ seed * 0x9e3779b9U);
}

/// In [0,1).
inline float unit_of(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }
inline float cell_value(int x, int y, std::uint32_t seed) { return unit_of(hash_cell(x, y, 0, seed)); }
/// std::floor is a function call on processors without SSE 4.1, and textures need little else.
inline int floor_int(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}
/// Part above the floor.
inline float fraction(float x) { return x - static_cast<float>(floor_int(x)); }

inline float lerp(float a, float b, float t) { return a + t * (b - a); }
inline float smooth(float t) { return t * t * (3.0F - 2.0F * t); }
/// 0 at `from` and before, 1 at `to` and beyond, smooth between; `from` may be the larger.
inline float smooth_step(float from, float to, float x) {
  const float t = (x - from) / (to - from);
  return t <= 0.0F ? 0.0F : t >= 1.0F ? 1.0F : smooth(t);
}

/// Value noise in [0,1]: random values at integer coordinates, smoothly interpolated. Never repeats.
float value_noise(float x, float y, std::uint32_t seed);
float value_noise(const Eigen::Vector3f& p, std::uint32_t seed);

/// Sum of octaves, each twice as fine and half as strong as the one before; in [0,1], mean 0.5.
float fractal_noise(float x, float y, int octaves, std::uint32_t seed);
float fractal_noise(const Eigen::Vector3f& p, int octaves, std::uint32_t seed);

/// Random numbers for building a scene: the same on every machine.
class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ULL + 0x632be59bd9b4e019ULL) {}
  std::uint32_t bits() {
    // splitmix64 (Steele, Lea, Flood 2014).
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
  }
  /// In [0,1).
  float unit() { return unit_of(bits()); }
  float between(float low, float high) { return low + (high - low) * unit(); }
  bool chance(float probability) { return unit() < probability; }
  /// In [0,n).
  int below(int n) { return static_cast<int>(unit() * static_cast<float>(n)); }

 private:
  std::uint64_t state_;
};

}  // namespace cmap
