#include "scene/town_ground.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sensors/noise.hpp"

namespace cmap {
namespace {

constexpr float kCell_m = 1.0F;

std::vector<float> center_lines(int blocks, float block, float street) {
  std::vector<float> lines;
  const float first = -0.5F * static_cast<float>(blocks - 2) * (block + street);
  for (int i = 0; i + 1 < blocks; ++i) lines.push_back(first + static_cast<float>(i) * (block + street));
  return lines;
}

/// A stretch of x (or y): across a street or its sidewalk, or between two streets.
struct Stretch {
  enum Kind { kRoad, kSidewalk, kBlock } kind;
  float begin, end;
};

std::vector<Stretch> stretches(const std::vector<float>& lines, float half_size, float street, float road_half) {
  std::vector<Stretch> result;
  float begin = -half_size;
  for (const float line : lines) {
    result.push_back({Stretch::kBlock, begin, line - 0.5F * street});
    result.push_back({Stretch::kSidewalk, line - 0.5F * street, line - road_half});
    result.push_back({Stretch::kRoad, line - road_half, line + road_half});
    result.push_back({Stretch::kSidewalk, line + road_half, line + 0.5F * street});
    begin = line + 0.5F * street;
  }
  result.push_back({Stretch::kBlock, begin, half_size});
  return result;
}

/// What lies where two stretches cross: a road runs through sidewalks, a sidewalk through blocks.
Stretch::Kind ground_kind(const Stretch& x, const Stretch& y) { return std::min(x.kind, y.kind); }

Surface ground_surface(const Stretch& x, const Stretch& y, float road_half, std::uint32_t seed) {
  Surface surface;
  surface.seed = seed;
  surface.origin = {x.begin, y.begin, 0.0F};
  surface.width = x.end - x.begin;
  surface.height = y.end - y.begin;
  switch (ground_kind(x, y)) {
    case Stretch::kRoad: {
      // u runs along the road, v across it from its center line; width 0 marks a crossing.
      surface.material = Material::kAsphalt;
      surface.base = {0.33F, 0.33F, 0.34F};
      const bool along_x = y.kind == Stretch::kRoad, along_y = x.kind == Stretch::kRoad;
      surface.height = 2.0F * road_half;
      if (along_x && along_y) {
        surface.width = 0.0F;
      } else if (along_x) {
        surface.origin.y() += road_half;
      } else if (along_y) {
        surface.origin.x() += road_half;
        surface.width = y.end - y.begin;
        surface.u_axis = Eigen::Vector3f::UnitY();
        surface.v_axis = -Eigen::Vector3f::UnitX();
      }
      break;
    }
    case Stretch::kSidewalk:
      surface.material = Material::kPaving;
      surface.base = {0.62F, 0.59F, 0.55F};
      break;
    case Stretch::kBlock:
      surface.material = Material::kGrass;
      surface.base = {0.34F, 0.46F, 0.20F};
      surface.accent = {0.47F, 0.42F, 0.26F};
      break;
  }
  return surface;
}

/// A patch of the height field, in cells of about kCell_m.
void add_patch(SceneBuilder& builder, std::uint32_t surface, const Stretch& x, const Stretch& y,
               const std::function<float(float, float)>& height) {
  const int nx = std::max(1, static_cast<int>(std::ceil((x.end - x.begin) / kCell_m)));
  const int ny = std::max(1, static_cast<int>(std::ceil((y.end - y.begin) / kCell_m)));
  const auto at = [&](int i, int j) {
    const float px = x.begin + (x.end - x.begin) * static_cast<float>(i) / static_cast<float>(nx);
    const float py = y.begin + (y.end - y.begin) * static_cast<float>(j) / static_cast<float>(ny);
    return Eigen::Vector3f(px, py, height(px, py));
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) builder.quad(surface, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

/// The face of a curb along a line from `from` to `to`, road on its right-hand side.
void add_curb(SceneBuilder& builder, std::uint32_t surface, const TownLayout& layout, const Eigen::Vector2f& from,
              const Eigen::Vector2f& to) {
  const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kCell_m)));
  const auto at = [&](int i, float above) {
    const Eigen::Vector2f p = from + (to - from) * static_cast<float>(i) / static_cast<float>(n);
    return Eigen::Vector3f(p.x(), p.y(), layout.road_height(p.x(), p.y()) + above);
  };
  for (int i = 0; i < n; ++i) {
    builder.quad(surface, at(i, 0.0F), at(i + 1, 0.0F), at(i + 1, TownLayout::kCurb_m), at(i, TownLayout::kCurb_m));
  }
}

void add_curbs(SceneBuilder& builder, const TownLayout& layout, const std::vector<Stretch>& xs,
               const std::vector<Stretch>& ys) {
  Surface stone;
  stone.material = Material::kStone;
  stone.base = {0.66F, 0.65F, 0.62F};
  const std::uint32_t surface = builder.add(stone);
  for (const Stretch& x : xs) {
    for (const Stretch& y : ys) {
      if (x.kind == Stretch::kRoad && y.kind != Stretch::kRoad) {
        add_curb(builder, surface, layout, {x.begin, y.begin}, {x.begin, y.end});
        add_curb(builder, surface, layout, {x.end, y.end}, {x.end, y.begin});
      } else if (y.kind == Stretch::kRoad && x.kind != Stretch::kRoad) {
        add_curb(builder, surface, layout, {x.end, y.begin}, {x.begin, y.begin});
        add_curb(builder, surface, layout, {x.begin, y.end}, {x.end, y.end});
      }
    }
  }
}

}  // namespace

TownLayout::TownLayout(const TownOptions& options)
    : block_x(static_cast<float>(options.block_x_m)),
      block_y(static_cast<float>(options.block_y_m)),
      street(static_cast<float>(options.street_width_m)),
      streets_x(center_lines(options.blocks_x, block_x, street)),
      streets_y(center_lines(options.blocks_y, block_y, street)),
      half_x(streets_x.back() + 0.5F * street + block_x + kMargin_m),
      half_y(streets_y.back() + 0.5F * street + block_y + kMargin_m),
      undulation_(static_cast<float>(options.undulation_m)),
      seed_(static_cast<std::uint32_t>(options.seed)) {}

float TownLayout::road_height(float x, float y) const {
  return undulation_ * (2.0F * fractal_noise(x / 55.0F, y / 55.0F, 2, seed_ + 901) - 1.0F);
}

Eigen::Vector2f TownLayout::block_corner(int i, int j) const {
  return {streets_x.front() - 0.5F * street - block_x + static_cast<float>(i) * (block_x + street),
          streets_y.front() - 0.5F * street - block_y + static_cast<float>(j) * (block_y + street)};
}

void add_town_ground(SceneBuilder& builder, const TownLayout& layout, std::uint32_t seed) {
  const std::vector<Stretch> xs = stretches(layout.streets_x, layout.half_x, layout.street, layout.road_half_width());
  const std::vector<Stretch> ys = stretches(layout.streets_y, layout.half_y, layout.street, layout.road_half_width());
  for (const Stretch& x : xs) {
    for (const Stretch& y : ys) {
      const float above = ground_kind(x, y) == Stretch::kRoad ? 0.0F : TownLayout::kCurb_m;
      const std::uint32_t surface = builder.add(ground_surface(x, y, layout.road_half_width(), seed++));
      add_patch(builder, surface, x, y, [&](float px, float py) { return layout.road_height(px, py) + above; });
    }
  }
  add_curbs(builder, layout, xs, ys);
}

}  // namespace cmap
