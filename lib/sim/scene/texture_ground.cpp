#include <algorithm>
#include <cmath>

#include "scene/textures.hpp"

namespace cmap {
namespace {

const RgbF kPaint = {0.80F, 0.80F, 0.77F};

/// How much of the road's paint lies here, [0,1]. u along the road, v from its center line.
float road_paint(const Surface& s, float u, float v) {
  if (s.width <= 0.0F) return 0.0F;  // a crossing
  const float half = 0.5F * s.height, from_end = std::min(u, s.width - u);
  if (from_end < 4.2F) {
    if (from_end > 1.0F && from_end < 3.8F && std::abs(v) < half - 0.4F) {  // zebra
      const float stripe = (v + half) / 1.0F;
      return fraction(stripe) < 0.5F ? 1.0F : 0.0F;
    }
    return 0.0F;
  }
  if (from_end < 4.9F) return from_end > 4.5F && std::abs(v) < half - 0.3F ? 1.0F : 0.0F;  // where cars stop
  const float dash = u / 4.5F;
  if (std::abs(v) < 0.07F && fraction(dash) < 0.6F) return 1.0F;
  // Parking bays at the curb.
  const float bay = u / 5.5F, in_bay = (fraction(bay)) * 5.5F;
  const float line = half - 2.05F;
  if (half > 3.5F && std::abs(std::abs(v) - line) < 0.05F) return 1.0F;
  return half > 3.5F && std::abs(v) > line && in_bay < 0.1F ? 1.0F : 0.0F;
}

/// A spot somewhere in each cell of a unit lattice, at least 0.2 from the cell's edge: how far away that of this cell
/// is, and which one it is.
struct Spot {
  float sq_distance;
  std::uint32_t id;
};
Spot spot_of_cell(float x, float y, std::uint32_t seed) {
  const int ix = floor_int(x), iy = floor_int(y);
  const std::uint32_t id = hash_cell(ix, iy, 7, seed), other = mix_bits(id + 1);
  const float dx = x - static_cast<float>(ix) - lerp(0.2F, 0.8F, unit_of(id));
  const float dy = y - static_cast<float>(iy) - lerp(0.2F, 0.8F, unit_of(other));
  return {dx * dx + dy * dy, mix_bits(other + 1)};
}

}  // namespace

namespace {

/// Patches where the road was opened.
float patched(const Surface& s, float x, float y) {
  const std::uint32_t id = hash_cell(floor_int(x / 5.3F), floor_int(y / 4.1F), 3, s.seed);
  if (unit_of(id) > 0.35F) return 1.0F;
  const float fx = fraction(x / 5.3F), fy = fraction(y / 4.1F), reach = 0.3F + 0.5F * unit_of(mix_bits(id));
  return fx > 0.1F && fx < reach && fy > 0.15F && fy < 0.65F ? 0.76F : 1.0F;
}

}  // namespace

RgbF asphalt_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float x = p.x(), y = p.y();
  constexpr float kCover_m = 9.0F, kOil_m = 3.7F;
  const Spot cover = spot_of_cell(x / kCover_m, y / kCover_m, 24);
  constexpr float kCoverRadius = 0.33F / kCover_m;
  if (cover.sq_distance < kCoverRadius * kCoverRadius) {
    const bool on_ring = fraction(std::sqrt(cover.sq_distance) * kCover_m / 0.055F) < 0.5F;
    return times({0.30F, 0.27F, 0.25F}, on_ring ? 1.0F : 0.65F);
  }
  const float speckle = value_noise(42.0F * x, 42.0F * y, 21);
  const float coarse = fractal_noise(0.4F * x, 0.4F * y, 6, 22);
  const Spot oil = spot_of_cell(x / kOil_m, y / kOil_m, 25);
  const float oil_radius = 0.05F + 0.12F * unit_of(oil.id);
  const float clean = smooth_step(0.0F, oil_radius * oil_radius, oil.sq_distance);
  const float crack = std::abs(coarse - 0.5F) < 0.003F ? 0.55F : 1.0F;
  const float tone =
      varied(speckle, 0.16F) * varied(coarse, 0.40F) * patched(s, x, y) * crack * (0.68F + 0.32F * clean);
  const auto [u, v] = uv_of(s, p);
  const float paint = road_paint(s, u, v);
  if (paint <= 0.0F) return times(s.base, tone);
  const float worn = smooth_step(0.34F, 0.54F, fractal_noise(2.5F * x, 2.5F * y, 3, 26));
  return mixed(times(s.base, tone), times(kPaint, varied(coarse, 0.25F) * varied(speckle, 0.06F)),
               0.92F * worn * paint);
}

RgbF paving_texture(const Surface& s, const Eigen::Vector3f& p) {
  constexpr float kSlab_m = 0.5F;
  const float x = p.x() / kSlab_m, y = p.y() / kSlab_m;
  const int ix = floor_int(x), iy = floor_int(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float grain = fractal_noise(18.0F * p.x(), 18.0F * p.y(), 2, 31);
  const float dirt = fractal_noise(0.7F * p.x(), 0.7F * p.y(), 4, 32);
  const bool in_joint = fx < 0.03F || fy < 0.03F;
  const float tone = in_joint ? 0.55F : varied(cell_value(ix, iy, 33), 0.13F);
  const Spot gum = spot_of_cell(p.x() / 0.6F, p.y() / 0.6F, 34);
  const float spot = gum.sq_distance < 0.0036F && unit_of(gum.id) < 0.35F ? 0.72F : 1.0F;
  return times(s.base, tone * spot * varied(grain, 0.16F) * varied(dirt, 0.26F));
}

RgbF grass_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float blades = fractal_noise(22.0F * p.x(), 22.0F * p.y(), 2, s.seed + 41);
  const float tufts = fractal_noise(2.2F * p.x(), 2.2F * p.y(), 3, 42);
  const float dry = smooth_step(0.47F, 0.72F, fractal_noise(0.22F * p.x(), 0.22F * p.y(), 4, 43));
  const RgbF color = mixed(s.base, s.accent, 0.75F * dry);
  const Spot flower = spot_of_cell(p.x() / 0.55F, p.y() / 0.55F, 44);
  if (flower.sq_distance < 0.0056F && unit_of(flower.id) < 0.22F * (1.0F - dry)) {
    return unit_of(mix_bits(flower.id)) < 0.5F ? RgbF{0.90F, 0.89F, 0.80F} : RgbF{0.88F, 0.78F, 0.18F};
  }
  return times(color, varied(blades, 0.24F) * varied(tufts, 0.32F));
}

RgbF gravel_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float stones = fractal_noise(19.0F * p.x(), 19.0F * p.y(), 2, s.seed + 51);
  return times(s.base, varied(stones, 0.28F) * varied(fractal_noise(0.8F * p.x(), 0.8F * p.y(), 4, 52), 0.25F));
}

RgbF crop_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  // width: distance between the rows, m. They waver as a tractor does.
  const float wavering = v + 0.5F * (fractal_noise(0.05F * u, 0.05F * v, 2, s.seed + 61) - 0.5F);
  const float row = wavering / s.width;
  const float between = std::abs(fraction(row) - 0.5F) * 2.0F;
  const float plants = fractal_noise(2.6F * u, 2.6F * v, 3, s.seed + 62);
  const float growth = fractal_noise(0.06F * u, 0.06F * v, 5, s.seed + 63);
  const float soil = smooth_step(0.35F, 0.8F, between + 0.9F * (0.5F - plants) + 0.5F * (0.45F - growth));
  const float lane = wavering / 18.0F, in_lane = (fraction(lane)) * 18.0F;
  const bool on_track = in_lane < 0.45F || (in_lane > 1.8F && in_lane < 2.25F);
  const RgbF color = mixed(s.base, s.accent, std::max(soil, on_track ? 0.85F : 0.0F));
  return times(color,
               varied(plants, 0.30F) * varied(growth, 0.40F) * varied(value_noise(9.0F * u, 9.0F * v, s.seed), 0.12F));
}

RgbF water_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float depth = fractal_noise(0.05F * p.x(), 0.05F * p.y(), 4, s.seed + 71);
  const float ripples = fractal_noise(1.2F * p.x() + 0.8F * p.y(), 2.1F * p.y(), 4, s.seed + 72);
  const float glint = smooth_step(0.68F, 0.80F, ripples);
  return mixed(times(mixed(s.base, s.accent, depth), varied(ripples, 0.28F)), {0.75F, 0.80F, 0.82F}, 0.45F * glint);
}

}  // namespace cmap
