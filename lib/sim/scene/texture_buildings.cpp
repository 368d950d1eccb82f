#include <algorithm>
#include <cmath>

#include "scene/textures.hpp"

namespace cmap {
namespace {

/// Dirt that runs down a wall, and stains.
float weathering(float u, float v, std::uint32_t seed) {
  const float streaks = fractal_noise(1.3F * u, 0.12F * v, 2, seed + 11);
  const float stains = fractal_noise(0.35F * u, 0.35F * v, 3, seed + 12);
  return varied(streaks, 0.13F) * varied(stains, 0.22F);
}

/// Which brick or tile of a running bond: row, number in the row, and where in it (from its lower left corner, m).
struct Bond {
  int row, column;
  float x, y;
};
Bond bond_at(float u, float v, float width, float height) {
  const int row = floor_int(v / height);
  const float shifted = u + (row % 2 == 0 ? 0.0F : 0.5F * width);
  const int column = floor_int(shifted / width);
  return {row, column, shifted - static_cast<float>(column) * width, v - static_cast<float>(row) * height};
}

RgbF laid_stones(const Surface& s, const Eigen::Vector3f& p, float width, float height, float joint, float contrast) {
  const auto [u, v] = uv_of(s, p);
  const Bond b = bond_at(u, v, width, height);
  const float grain = fractal_noise(12.0F * u, 12.0F * v, 2, s.seed + 3);
  const float dirt = weathering(u, v, s.seed);
  if (b.x < joint || b.y < joint) return times(s.accent, dirt * varied(grain, 0.15F));
  const float tone = varied(cell_value(b.column, b.row, s.seed), contrast);
  const float warmth = 0.06F * (cell_value(b.column, b.row, s.seed + 1) - 0.5F);
  const float f = tone * dirt * varied(grain, 0.18F);
  return {(s.base[0] + warmth) * f, s.base[1] * f, (s.base[2] - warmth) * f};
}

/// What is seen behind a pane: a dark room, a curtain or a blind.
RgbF behind_pane(const Surface& s, float u, float v) {
  const std::uint32_t seed = s.seed;
  const float kind = unit_of(mix_bits(seed + 1)), tone = unit_of(mix_bits(seed + 2));
  const float sheen = fractal_noise(0.9F * (u + v), 0.9F * v - 0.5F * u, 3, seed + 3);  // a hint of what is opposite
  const float bright = 0.33F + 0.85F * sheen;
  const RgbF glass = {bright * s.accent[0], bright * s.accent[1], bright * s.accent[2]};
  if (kind < 0.35F) {  // curtains drawn to both sides
    const float open = 0.12F + 0.30F * tone;
    const float from_middle = std::abs(u / s.width - 0.5F);
    if (from_middle < 0.5F - open) return glass;
    const float fold = 0.78F + 0.22F * std::sin(45.0F * u + 4.0F * value_noise(3.0F * u, v, seed));
    return times({0.78F, 0.70F + 0.12F * tone, 0.58F + 0.2F * tone}, fold);
  }
  if (kind < 0.55F) {  // a blind, partly down
    if (v / s.height < tone) return glass;
    const float slat = fraction(v / 0.06F);
    return times({0.80F, 0.79F, 0.74F}, 0.72F + 0.28F * slat);
  }
  return times(glass, 0.75F + 0.5F * tone);
}

}  // namespace

RgbF brick_texture(const Surface& s, const Eigen::Vector3f& p) {
  return laid_stones(s, p, 0.25F, 0.077F, 0.012F, 0.22F);
}

RgbF stone_texture(const Surface& s, const Eigen::Vector3f& p) { return laid_stones(s, p, 0.72F, 0.34F, 0.02F, 0.14F); }

RgbF plaster_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const float grain = fractal_noise(11.0F * u, 11.0F * v, 2, s.seed + 5);
  const float uneven = fractal_noise(0.8F * u, 0.8F * v, 4, s.seed + 6);
  const float dark = std::abs(uneven - 0.44F) < 0.003F ? 0.80F : varied(uneven, 0.10F);  // a crack
  return times(s.base, weathering(u, v, s.seed) * varied(grain, 0.10F) * dark);
}

RgbF window_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  constexpr float kFrame_m = 0.065F, kBar_m = 0.025F;
  const float edge = std::min(std::min(u, s.width - u), std::min(v, s.height - v));
  const bool on_bar = std::abs(u - 0.5F * s.width) < kBar_m || std::abs(v - 0.68F * s.height) < kBar_m;
  if (edge < kFrame_m || on_bar) return times(s.base, varied(fractal_noise(8.0F * u, 8.0F * v, 2, s.seed), 0.10F));
  return behind_pane(s, u, v);
}

RgbF door_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const float grain = fractal_noise(24.0F * u, 1.6F * v, 3, s.seed);
  // Panels: sunk fields, two columns of three.
  const float pu = 2.0F * u / s.width, pv = 3.0F * v / s.height;
  const float fu = fraction(pu), fv = fraction(pv);
  const float rim = std::min(std::min(fu, 1.0F - fu) * 0.5F * s.width, std::min(fv, 1.0F - fv) * s.height / 3.0F);
  const float groove = rim > 0.06F && rim < 0.085F ? 0.55F : 1.0F;
  const float handle_u = u - 0.88F * s.width, handle_v = v - 0.47F * s.height;
  if (std::abs(handle_u) < 0.03F && std::abs(handle_v) < 0.08F) return {0.75F, 0.72F, 0.62F};
  const float worn = varied(fractal_noise(1.5F * u, 1.5F * v, 3, s.seed + 1), 0.2F);
  return times(s.base, varied(grain, 0.22F) * groove * worn);
}

RgbF roof_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const Bond b = bond_at(u, v, 0.28F, 0.34F);
  const float round = std::sin(b.x / 0.28F * 3.1415927F);
  const float shade = (0.72F + 0.28F * round) * (b.y < 0.05F ? 0.6F : 1.0F);
  const float tone = varied(cell_value(b.column, b.row, s.seed), 0.20F);
  const float age = varied(fractal_noise(0.4F * u, 0.4F * v, 4, s.seed + 2), 0.30F);
  const float moss = smooth_step(0.58F, 0.75F, fractal_noise(0.9F * u, 0.6F * v, 4, s.seed + 4));
  return mixed(times(s.base, shade * tone * age), {0.30F, 0.34F, 0.20F}, 0.55F * moss);
}

}  // namespace cmap
