#include "sim/noise.hpp"

namespace cmap {

float value_noise(float x, float y, std::uint32_t seed) {
  const int ix = floor_int(x), iy = floor_int(y);
  const float tx = smooth(x - static_cast<float>(ix)), ty = smooth(y - static_cast<float>(iy));
  const float low = lerp(cell_value(ix, iy, seed), cell_value(ix + 1, iy, seed), tx);
  const float high = lerp(cell_value(ix, iy + 1, seed), cell_value(ix + 1, iy + 1, seed), tx);
  return lerp(low, high, ty);
}

float value_noise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const int iz = floor_int(p.z());
  const std::uint32_t below = mix_bits(seed ^ static_cast<std::uint32_t>(iz) * 0xcb1ab31fU);
  const std::uint32_t above = mix_bits(seed ^ static_cast<std::uint32_t>(iz + 1) * 0xcb1ab31fU);
  const float t = smooth(p.z() - static_cast<float>(iz));
  return lerp(value_noise(p.x(), p.y(), below), value_noise(p.x(), p.y(), above), t);
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
