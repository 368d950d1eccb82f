#include "sensors/noise.hpp"

namespace cmap {

namespace {

constexpr std::uint32_t kStepX = 0x8da6b343U, kStepY = 0xd8163841U, kStepZ = 0xcb1ab31fU;

/// Value in [0,2^24) of a corner of the lattice. Half of mix_bits: noise is smoothed, so that this is random enough.
float corner_value(std::uint32_t h) {
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 13)) * 0x297a2d39U;
  return static_cast<float>(static_cast<std::int32_t>(h >> 8));
}

/// Of the four corners of a cell, weighted.
float bilinear(std::uint32_t h, float tx, float ty) {
  const float low = lerp(corner_value(h), corner_value(h + kStepX), tx);
  const float high = lerp(corner_value(h + kStepY), corner_value(h + kStepX + kStepY), tx);
  return lerp(low, high, ty);
}

}  // namespace

float value_noise(float x, float y, std::uint32_t seed) {
  const int ix = floor_int(x), iy = floor_int(y);
  const std::uint32_t h =
      static_cast<std::uint32_t>(ix) * kStepX + static_cast<std::uint32_t>(iy) * kStepY + seed * 0x9e3779b9U;
  return 0x1p-24F * bilinear(h, smooth(x - static_cast<float>(ix)), smooth(y - static_cast<float>(iy)));
}

float value_noise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const int ix = floor_int(p.x()), iy = floor_int(p.y()), iz = floor_int(p.z());
  const std::uint32_t h = static_cast<std::uint32_t>(ix) * kStepX + static_cast<std::uint32_t>(iy) * kStepY +
                          static_cast<std::uint32_t>(iz) * kStepZ + seed * 0x9e3779b9U;
  const float tx = smooth(p.x() - static_cast<float>(ix)), ty = smooth(p.y() - static_cast<float>(iy));
  const float tz = smooth(p.z() - static_cast<float>(iz));
  return 0x1p-24F * lerp(bilinear(h, tx, ty), bilinear(h + kStepZ, tx, ty), tz);
}

float fractal_noise(float x, float y, int octaves, std::uint32_t seed) {
  float sum = 0.0F, weight = 1.0F, total = 0.0F;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(x, y, seed + static_cast<std::uint32_t>(octave));
    total += weight;
    weight *= 0.5F;
    x *= 2.03F;  // not exactly 2: the octaves' lattices must not coincide
    y *= 2.03F;
  }
  return sum / total;
}

float fractal_noise(const Eigen::Vector3f& p, int octaves, std::uint32_t seed) {
  float sum = 0.0F, weight = 1.0F, total = 0.0F;
  Eigen::Vector3f q = p;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(q, seed + static_cast<std::uint32_t>(octave));
    total += weight;
    weight *= 0.5F;
    q *= 2.03F;
  }
  return sum / total;
}

}  // namespace cmap
