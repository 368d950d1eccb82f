#include <algorithm>
#include <cmath>

#include "scene/textures.hpp"

namespace cmap {
namespace {

/// A color of a poster or a book's back: saturated, of any hue.
RgbF vivid(std::uint32_t bits) {
  const float hue = 6.2831853F * unit_of(bits), value = 0.35F + 0.55F * unit_of(mix_bits(bits + 1));
  const float strength = 0.15F + 0.30F * unit_of(mix_bits(bits + 2));
  return {value * (1.0F - strength + strength * std::cos(hue)),
          value * (1.0F - strength + strength * std::cos(hue - 2.1F)),
          value * (1.0F - strength + strength * std::cos(hue + 2.1F))};
}

}  // namespace

RgbF plain_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float stains = fractal_noise(Eigen::Vector3f(1.4F * p), 3, s.seed + 81);
  const float grain = value_noise(Eigen::Vector3f(21.0F * p), s.seed + 82);
  return times(s.base, varied(stains, 0.17F) * varied(grain, 0.06F));
}

RgbF leaves_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float tone = value_noise(Eigen::Vector3f(7.0F * p), s.seed + 91);
  const float branch = fractal_noise(Eigen::Vector3f(0.9F * p), 3, s.seed + 92);
  // Deep inside a crown it is dark.
  return times(mixed(s.base, s.accent, smooth_step(0.35F, 0.9F, 0.5F * (tone + branch))),
               varied(tone, 0.38F) * varied(branch, 0.3F));
}

RgbF bark_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float ridges = fractal_noise(Eigen::Vector3f(16.0F * p.x(), 16.0F * p.y(), 3.0F * p.z()), 3, s.seed + 95);
  return times(s.base, varied(ridges, 0.5F));
}

RgbF car_paint_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float dust = fractal_noise(Eigen::Vector3f(1.9F * p), 3, s.seed + 101);
  const float fine = value_noise(Eigen::Vector3f(14.0F * p), s.seed + 102);
  return mixed(times(s.base, varied(fine, 0.06F)), {0.55F, 0.51F, 0.45F}, 0.38F * smooth_step(0.35F, 0.75F, dust));
}

RgbF metal_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float brushed = fractal_noise(Eigen::Vector3f(3.0F * p.x(), 3.0F * p.y(), 17.0F * p.z()), 3, s.seed + 111);
  const float rust = smooth_step(0.62F, 0.75F, fractal_noise(Eigen::Vector3f(2.2F * p), 3, s.seed + 112));
  return mixed(times(s.base, varied(brushed, 0.2F)), {0.42F, 0.27F, 0.17F}, 0.5F * rust);
}

RgbF wood_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const bool is_wide = s.width > s.height;
  const float along = is_wide ? u : v, across = is_wide ? v : u;
  const float bend = fractal_noise(0.8F * along, 2.0F * across, 3, s.seed + 121);
  const float ring = 0.5F + 0.5F * std::sin(60.0F * across + 16.0F * bend);
  const float fiber = fractal_noise(4.0F * along, 70.0F * across, 2, s.seed + 122);
  return times(s.base, varied(ring, 0.14F) * varied(fiber, 0.18F) * varied(bend, 0.2F));
}

RgbF picture_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const float edge = std::min(std::min(u, s.width - u), std::min(v, s.height - v));
  const float size = std::min(s.width, s.height);
  if (edge < 0.05F * size) return times(vivid(s.seed + 7), 0.4F);
  // Blots and bars of a few colors, and lines as of text.
  const float x = u / size, y = v / size;
  const float blot = fractal_noise(3.0F * x, 3.0F * y, 4, s.seed);
  const float other = fractal_noise(2.0F * x + 9.0F, 2.0F * y, 3, s.seed + 1);
  RgbF color = mixed(vivid(s.seed), vivid(s.seed + 1), smooth_step(0.42F, 0.50F, blot));
  color = mixed(color, vivid(s.seed + 2), smooth_step(0.55F, 0.58F, other));
  const int line = floor_int(14.0F * y);
  const bool has_text = cell_value(line / 5, 3, s.seed) < 0.45F && line % 2 == 0;
  if (has_text && cell_value(floor_int(26.0F * x), line, s.seed) < 0.6F && edge > 0.12F * size)
    return vivid(s.seed + 3);
  return color;
}

RgbF paint_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const float roller = fractal_noise(14.0F * u, 14.0F * v, 2, s.seed + 141);
  const float uneven = fractal_noise(0.9F * u, 0.9F * v, 4, s.seed + 142);
  // Scuffs and marks, most of them low.
  const float scuff = smooth_step(0.68F, 0.74F, fractal_noise(6.0F * u, 14.0F * v, 3, s.seed + 143));
  return times(s.base,
               varied(roller, 0.06F) * varied(uneven, 0.13F) * (1.0F - 0.12F * scuff * smooth_step(1.6F, 0.2F, v)));
}

RgbF carpet_texture(const Surface& s, const Eigen::Vector3f& p) {
  constexpr float kTile_m = 0.5F;
  const int ix = floor_int(p.x() / kTile_m), iy = floor_int(p.y() / kTile_m);
  const std::uint32_t bits = hash_cell(ix, iy, 1, s.seed);
  // Tiles are laid with their stripes one way or the other.
  const float along = (bits & 1U) != 0 ? p.x() : p.y();
  const float stripe = value_noise(24.0F * along, static_cast<float>(bits % 97U), s.seed + 1);
  const float pile = value_noise(70.0F * p.x(), 70.0F * p.y(), s.seed + 2);
  const float trodden = fractal_noise(0.7F * p.x(), 0.7F * p.y(), 4, s.seed + 3);
  const RgbF color = mixed(s.base, s.accent, 0.65F * stripe + 0.25F * unit_of(bits));
  return times(color, varied(pile, 0.2F) * varied(trodden, 0.3F));
}

RgbF floor_tiles_texture(const Surface& s, const Eigen::Vector3f& p) {
  constexpr float kTile_m = 0.6F;
  const float x = p.x() / kTile_m, y = p.y() / kTile_m;
  const int ix = floor_int(x), iy = floor_int(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float dirt = varied(fractal_noise(0.8F * p.x(), 0.8F * p.y(), 4, s.seed + 2), 0.16F);
  if (fx < 0.012F || fy < 0.012F) return times({0.40F, 0.39F, 0.37F}, dirt);
  // Terrazzo: chips of stone; and veins that go through a tile, not through its neighbor.
  const std::uint32_t bits = hash_cell(ix, iy, 0, s.seed);
  const float chips = value_noise(38.0F * p.x(), 38.0F * p.y(), s.seed + 1);
  const float vein = std::abs(fractal_noise(2.0F * x, 2.0F * y, 4, bits) - 0.5F);
  const float tone = varied(unit_of(bits), 0.10F) * (chips > 0.78F ? 0.74F : chips < 0.2F ? 1.12F : 1.0F);
  return times(mixed(s.base, s.accent, 0.6F * (1.0F - smooth_step(0.0F, 0.03F, vein))), tone * dirt);
}

RgbF ceiling_texture(const Surface& s, const Eigen::Vector3f& p) {
  constexpr float kTile_m = 0.6F;
  const float x = p.x() / kTile_m, y = p.y() / kTile_m;
  const int ix = floor_int(x), iy = floor_int(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  if (fx < 0.035F || fy < 0.035F) return {0.62F, 0.62F, 0.61F};
  if (ix % 4 == 0 && iy % 3 == 0) {  // a lamp
    return {1.15F, 1.15F, 1.10F};
  }
  const float stain = smooth_step(0.60F, 0.72F, fractal_noise(0.8F * p.x(), 0.8F * p.y(), 4, s.seed));
  const float hole = value_noise(60.0F * p.x(), 60.0F * p.y(), s.seed + 1) < 0.2F ? 0.80F : 1.0F;
  const float tone = varied(cell_value(ix, iy, s.seed + 2), 0.05F) * hole;
  return mixed(times(s.base, tone), {0.70F, 0.62F, 0.46F}, 0.5F * stain);
}

RgbF books_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  constexpr float kShelf_m = 0.36F, kBook_m = 0.042F;
  const int shelf = floor_int(v / kShelf_m);
  const float up = v - static_cast<float>(shelf) * kShelf_m;
  if (up < 0.025F || u < 0.025F || s.width - u < 0.025F) return wood_texture(s, p);
  const int book = floor_int(u / kBook_m + 0.5F * value_noise(5.0F * u, static_cast<float>(shelf), s.seed));
  const std::uint32_t bits = hash_cell(book, shelf, 5, s.seed);
  const float height = 0.20F + 0.12F * unit_of(mix_bits(bits + 9));
  if (up > 0.025F + height || cell_value(book / 9, shelf, s.seed + 1) < 0.15F) return {0.13F, 0.11F, 0.10F};
  const float label = std::abs(up - 0.7F * height);
  return times(vivid(bits), label < 0.02F ? 1.5F : varied(value_noise(40.0F * u, 6.0F * v, s.seed), 0.15F));
}

RgbF screen_texture(const Surface& s, const Eigen::Vector3f& p) {
  const auto [u, v] = uv_of(s, p);
  const float edge = std::min(std::min(u, s.width - u), std::min(v, s.height - v));
  if (edge < 0.02F) return {0.08F, 0.08F, 0.09F};
  const int line = floor_int(v / 0.018F);
  const float indent = 0.06F + 0.05F * static_cast<float>(hash_cell(line, 1, 0, s.seed) % 4U);
  const float length = 0.6F * s.width * cell_value(line, 2, s.seed);
  if (line % 2 == 0 && u > indent && u < indent + length && cell_value(floor_int(u / 0.02F), line, s.seed) < 0.75F) {
    return vivid(hash_cell(line, 4, 0, s.seed));
  }
  return unit_of(mix_bits(s.seed)) < 0.5F ? RgbF{0.14F, 0.15F, 0.18F} : RgbF{0.86F, 0.87F, 0.88F};
}

RgbF fabric_texture(const Surface& s, const Eigen::Vector3f& p) {
  const float weave = value_noise(Eigen::Vector3f(55.0F * p), s.seed + 131);
  const float wear = fractal_noise(Eigen::Vector3f(1.5F * p), 3, s.seed + 132);
  return times(s.base, varied(weave, 0.2F) * varied(wear, 0.28F));
}

}  // namespace cmap
