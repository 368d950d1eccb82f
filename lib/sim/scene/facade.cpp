#include "scene/facade.hpp"

#include <algorithm>

namespace cmap {
namespace {

constexpr float kBelowGround_m = 2.0F;
constexpr float kWindowPitch_m = 2.7F;

Surface dressed(Surface look, SceneRandom& random) {
  look.seed = random.bits();
  return look;
}

/// One storey of a wall: windows side by side, a door or a shop's window where it belongs.
class Storey {
 public:
  Storey(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, const WallPlane& wall, float length)
      : builder_(builder),
        random_(random),
        style_(style),
        wall_(wall),
        wall_surface_(builder.add(on_wall(wall, style.wall))),
        columns_(std::max(1, static_cast<int>(length / kWindowPitch_m))),
        pitch_(length / static_cast<float>(columns_)),
        window_half_(0.5F * std::min(0.5F * pitch_, random.between(1.0F, 1.5F))),
        door_column_(random.below(columns_)) {}

  void add(int storey, bool is_front) {
    for (int column = 0; column < columns_; ++column) {
      const float u0 = static_cast<float>(column) * pitch_, v0 = static_cast<float>(storey) * style_.storey_m;
      const WallRect cell{u0, u0 + pitch_, v0, v0 + style_.storey_m};
      if (storey == 0 && is_front && column == door_column_) {
        add_door(cell);
      } else if (storey == 0 && is_front && style_.has_shop) {
        add_shop(cell);
      } else {
        add_window(cell, is_front && storey > 0 && style_.has_balconies && (column + storey) % 2 == 0);
      }
    }
  }

 private:
  void add_door(const WallRect& cell) {
    const float middle = 0.5F * (cell.u0 + cell.u1);
    const WallRect opening{middle - 0.55F, middle + 0.55F, cell.v0 + 0.02F, cell.v0 + 2.25F};
    add_opening(builder_, wall_surface_, wall_, cell, opening, 0.22F, dressed(style_.door, random_));
    add_ledge(builder_, wall_, {opening.u0 - 0.25F, opening.u1 + 0.25F, cell.v0 - 0.6F, cell.v0 + 0.02F}, 0.7F,
              dressed(style_.trim, random_));
    add_ledge(builder_, wall_, {opening.u0 - 0.3F, opening.u1 + 0.3F, cell.v0 + 2.45F, cell.v0 + 2.57F}, 0.8F,
              dressed(style_.trim, random_));
  }

  void add_shop(const WallRect& cell) {
    const WallRect opening{cell.u0 + 0.12F, cell.u1 - 0.12F, cell.v0 + 0.45F, cell.v0 + 2.3F};
    Surface glass = dressed(style_.frame, random_);
    glass.material = Material::kWindow;
    add_opening(builder_, wall_surface_, wall_, cell, opening, 0.12F, glass);
    Surface sign;
    sign.material = Material::kPicture;
    sign.seed = random_.bits();
    add_ledge(builder_, wall_, {cell.u0 + 0.1F, cell.u1 - 0.1F, cell.v0 + 2.4F, cell.v0 + 2.85F}, 0.12F, sign);
  }

  void add_window(const WallRect& cell, bool has_balcony) {
    const float middle = 0.5F * (cell.u0 + cell.u1);
    const float sill = has_balcony ? 0.1F : 0.9F;
    const WallRect opening{middle - window_half_, middle + window_half_, cell.v0 + sill, cell.v0 + 2.4F};
    Surface glass = dressed(style_.frame, random_);
    glass.material = Material::kWindow;
    add_opening(builder_, wall_surface_, wall_, cell, opening, 0.16F, glass);
    if (has_balcony) return add_balcony({cell.u0 + 0.15F, cell.u1 - 0.15F, cell.v0 - 0.12F, cell.v0 + 0.05F});
    add_ledge(builder_, wall_, {opening.u0 - 0.1F, opening.u1 + 0.1F, opening.v0 - 0.08F, opening.v0}, 0.12F,
              dressed(style_.trim, random_));
    if (random_.chance(0.12F)) add_flower_box(opening);
  }

  void add_balcony(const WallRect& floor) {
    constexpr float kDepth_m = 1.1F;
    add_ledge(builder_, wall_, floor, kDepth_m, dressed(style_.trim, random_));
    Surface rail = style_.door;
    rail.material = Material::kMetal;
    const std::uint32_t surface = builder_.add(on_wall(wall_, rail));
    for (float u = floor.u0 + 0.03F; u < floor.u1; u += 0.18F) {
      builder_.cylinder(surface, wall_.at(u, floor.v1, kDepth_m - 0.05F),
                        wall_.at(u, floor.v1 + 0.95F, kDepth_m - 0.05F), 0.015F, 0.015F, 4);
    }
    builder_.cylinder(surface, wall_.at(floor.u0, floor.v1 + 0.95F, kDepth_m - 0.05F),
                      wall_.at(floor.u1, floor.v1 + 0.95F, kDepth_m - 0.05F), 0.03F, 0.03F, 6);
  }

  void add_flower_box(const WallRect& opening) {
    Surface flowers;
    flowers.material = Material::kGrass;
    flowers.base = {0.25F, 0.42F, 0.16F};
    flowers.accent = random_.chance(0.5F) ? RgbF{0.80F, 0.15F, 0.20F} : RgbF{0.85F, 0.65F, 0.15F};
    flowers.seed = random_.bits();
    add_ledge(builder_, wall_, {opening.u0, opening.u1, opening.v0 + 0.01F, opening.v0 + 0.22F}, 0.22F, flowers);
  }

  SceneBuilder& builder_;
  SceneRandom& random_;
  const HouseStyle& style_;
  const WallPlane& wall_;
  std::uint32_t wall_surface_;
  int columns_;
  float pitch_, window_half_;
  int door_column_;
};

void add_wall(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, const WallPlane& wall, float length,
              bool is_front) {
  Surface plinth = style.trim;
  plinth.material = Material::kStone;
  plinth.base = {0.50F, 0.48F, 0.46F};
  add_panel(builder, wall, {0.0F, length, -kBelowGround_m, 0.0F}, 0.0F, plinth);
  add_ledge(builder, wall, {0.0F, length, -kBelowGround_m, 0.35F}, 0.04F, plinth);
  Storey storey(builder, random, style, wall, length);
  for (int i = 0; i < style.storeys; ++i) {
    storey.add(i, is_front);
    const float top = static_cast<float>(i + 1) * style.storey_m;
    if (i == 0 || i + 1 == style.storeys) {
      add_ledge(builder, wall, {0.0F, length, top - 0.1F, top + 0.1F}, i == 0 ? 0.07F : 0.16F, style.trim);
    }
  }
}

void add_flat_roof(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, float width, float depth,
                   float top) {
  Surface gravel;
  gravel.material = Material::kGravel;
  gravel.base = {0.52F, 0.50F, 0.48F};
  gravel.seed = random.bits();
  builder.quad(builder.add(gravel), {0, 0, top}, {width, 0, top}, {width, depth, top}, {0, depth, top});
  constexpr float kThick_m = 0.25F, kParapet_m = 0.6F;
  builder.box(style.trim, {0, 0, top}, {width, kThick_m, top + kParapet_m});
  builder.box(style.trim, {0, depth - kThick_m, top}, {width, depth, top + kParapet_m});
  builder.box(style.trim, {0, kThick_m, top}, {kThick_m, depth - kThick_m, top + kParapet_m});
  builder.box(style.trim, {width - kThick_m, kThick_m, top}, {width, depth - kThick_m, top + kParapet_m});
  Surface metal;
  metal.material = Material::kMetal;
  metal.base = {0.66F, 0.67F, 0.68F};
  for (int i = 0; i < 3; ++i) {
    const float x = random.between(1.0F, width - 3.0F), y = random.between(1.0F, depth - 3.0F);
    builder.box(metal, {x, y, top},
                {x + random.between(0.8F, 2.0F), y + random.between(0.8F, 2.0F), top + random.between(0.5F, 1.6F)});
  }
}

/// A roof of two slopes, its ridge along x, with gables of wall.
void add_gable_roof(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, float width, float depth,
                    float top) {
  constexpr float kOverhang_m = 0.35F;
  const float rise = random.between(0.32F, 0.48F) * depth, slope = rise / (0.5F * depth);
  const float eave = top - kOverhang_m * slope, ridge = top + rise;
  const float x0 = -0.05F, x1 = width + 0.05F, y0 = -kOverhang_m, y1 = depth + kOverhang_m, ym = 0.5F * depth;
  Surface tiles = dressed(style.roof, random);
  tiles.origin = {x0, y0, eave};
  tiles.v_axis = Eigen::Vector3f(0, ym - y0, ridge - eave).normalized();
  builder.quad(builder.add(tiles), {x0, y0, eave}, {x1, y0, eave}, {x1, ym, ridge}, {x0, ym, ridge});
  tiles.origin = {x1, y1, eave};
  tiles.u_axis = -Eigen::Vector3f::UnitX();
  tiles.v_axis = Eigen::Vector3f(0, ym - y1, ridge - eave).normalized();
  builder.quad(builder.add(tiles), {x1, y1, eave}, {x0, y1, eave}, {x0, ym, ridge}, {x1, ym, ridge});
  const WallPlane left{{0, depth, 0}, {0, -1, 0}}, right{{width, 0, 0}, {0, 1, 0}};
  builder.triangle(builder.add(on_wall(left, style.wall)), {0, depth, top}, {0, 0, top}, {0, ym, ridge});
  builder.triangle(builder.add(on_wall(right, style.wall)), {width, 0, top}, {width, depth, top}, {width, ym, ridge});
  Surface chimney = style.wall;
  chimney.material = Material::kBrick;
  chimney.base = {0.55F, 0.30F, 0.24F};
  const float cx = random.between(0.2F, 0.8F) * width;
  builder.box(chimney, {cx, ym + 0.4F, top}, {cx + 0.7F, ym + 1.0F, ridge + 0.8F});
  // Skylights lie on the slope that faces the street.
  for (float x = 1.5F; x + 1.5F < width; x += random.between(2.5F, 5.0F)) {
    Surface glass = dressed(style.frame, random);
    glass.material = Material::kWindow;
    glass.width = 0.9F;
    glass.height = 1.2F;
    const Eigen::Vector3f up = Eigen::Vector3f(0, ym - y0, ridge - eave).normalized();
    const Eigen::Vector3f a = Eigen::Vector3f(x, 0, top) + (0.35F * depth * up) + Eigen::Vector3f(0, -0.05F, 0.07F);
    glass.origin = a;
    glass.v_axis = up;
    const Eigen::Vector3f b = a + 0.9F * Eigen::Vector3f::UnitX();
    builder.quad(builder.add(glass), a, b, b + 1.2F * up, a + 1.2F * up);
  }
}

RgbF pick(SceneRandom& random, std::initializer_list<RgbF> colors) {
  return colors.begin()[random.below(static_cast<int>(colors.size()))];
}

}  // namespace

Surface on_wall(const WallPlane& wall, Surface look) {
  look.origin = wall.start;
  look.u_axis = wall.along;
  look.v_axis = Eigen::Vector3f::UnitZ();
  return look;
}

void add_panel(SceneBuilder& builder, const WallPlane& wall, const WallRect& rect, float out, Surface look) {
  look = on_wall(wall, look);
  look.origin = wall.at(rect.u0, rect.v0, out);
  look.width = rect.u1 - rect.u0;
  look.height = rect.v1 - rect.v0;
  builder.quad(builder.add(look), wall.at(rect.u0, rect.v0, out), wall.at(rect.u1, rect.v0, out),
               wall.at(rect.u1, rect.v1, out), wall.at(rect.u0, rect.v1, out));
}

void add_ledge(SceneBuilder& builder, const WallPlane& wall, const WallRect& rect, float out, Surface look) {
  add_panel(builder, wall, rect, out, look);
  const std::uint32_t edge = builder.add(on_wall(wall, look));
  const auto at = [&](float u, float v, float w) { return wall.at(u, v, w); };
  const auto& [u0, u1, v0, v1] = rect;
  builder.quad(edge, at(u0, v1, out), at(u1, v1, out), at(u1, v1, 0), at(u0, v1, 0));
  builder.quad(edge, at(u0, v0, 0), at(u1, v0, 0), at(u1, v0, out), at(u0, v0, out));
  builder.quad(edge, at(u0, v0, 0), at(u0, v0, out), at(u0, v1, out), at(u0, v1, 0));
  builder.quad(edge, at(u1, v0, out), at(u1, v0, 0), at(u1, v1, 0), at(u1, v1, out));
}

void add_opening(SceneBuilder& builder, std::uint32_t wall_surface, const WallPlane& wall, const WallRect& cell,
                 const WallRect& opening, float recess_m, Surface fill) {
  const auto patch = [&](float u0, float u1, float v0, float v1) {
    builder.quad(wall_surface, wall.at(u0, v0), wall.at(u1, v0), wall.at(u1, v1), wall.at(u0, v1));
  };
  const auto& [u0, u1, v0, v1] = opening;
  patch(cell.u0, cell.u1, cell.v0, v0);
  patch(cell.u0, cell.u1, v1, cell.v1);
  patch(cell.u0, u0, v0, v1);
  patch(u1, cell.u1, v0, v1);
  const float in = -recess_m;
  const auto at = [&](float u, float v, float w) { return wall.at(u, v, w); };
  builder.quad(wall_surface, at(u0, v0, 0), at(u1, v0, 0), at(u1, v0, in), at(u0, v0, in));
  builder.quad(wall_surface, at(u1, v1, 0), at(u0, v1, 0), at(u0, v1, in), at(u1, v1, in));
  builder.quad(wall_surface, at(u0, v1, 0), at(u0, v0, 0), at(u0, v0, in), at(u0, v1, in));
  builder.quad(wall_surface, at(u1, v0, 0), at(u1, v1, 0), at(u1, v1, in), at(u1, v0, in));
  add_panel(builder, wall, opening, in, fill);
}

HouseStyle random_house_style(SceneRandom& random, int storeys) {
  HouseStyle style;
  style.storeys = storeys;
  style.storey_m = random.between(2.9F, 3.3F);
  style.wall.seed = random.bits();
  const int kind = random.below(5);
  style.wall.material = kind < 2 ? Material::kBrick : kind < 4 ? Material::kPlaster : Material::kStone;
  style.wall.base =
      kind < 2
          ? pick(random, {{0.62F, 0.33F, 0.26F}, {0.70F, 0.52F, 0.38F}, {0.52F, 0.30F, 0.27F}, {0.72F, 0.63F, 0.50F}})
      : kind < 4 ? pick(random, {{0.88F, 0.80F, 0.62F},
                                 {0.85F, 0.68F, 0.55F},
                                 {0.72F, 0.80F, 0.78F},
                                 {0.86F, 0.84F, 0.80F},
                                 {0.66F, 0.74F, 0.60F},
                                 {0.82F, 0.60F, 0.50F}})
                 : pick(random, {{0.70F, 0.67F, 0.60F}, {0.62F, 0.60F, 0.58F}});
  style.wall.accent = {0.74F, 0.72F, 0.68F};
  style.trim.material = Material::kPlain;
  style.trim.base = pick(random, {{0.86F, 0.85F, 0.82F}, {0.76F, 0.72F, 0.66F}, {0.62F, 0.60F, 0.57F}});
  style.trim.seed = random.bits();
  style.roof.material = Material::kRoofTiles;
  style.roof.base =
      pick(random, {{0.62F, 0.29F, 0.21F}, {0.50F, 0.27F, 0.22F}, {0.36F, 0.37F, 0.41F}, {0.55F, 0.40F, 0.30F}});
  style.frame.base = pick(random, {{0.90F, 0.90F, 0.88F}, {0.35F, 0.25F, 0.20F}, {0.25F, 0.33F, 0.30F}});
  style.frame.accent = {0.38F, 0.44F, 0.52F};  // of the glass
  style.door.material = Material::kDoor;
  style.door.base =
      pick(random, {{0.45F, 0.28F, 0.18F}, {0.18F, 0.30F, 0.24F}, {0.55F, 0.16F, 0.14F}, {0.20F, 0.26F, 0.42F}});
  style.has_shop = random.chance(0.3F);
  style.has_balconies = random.chance(0.35F);
  style.has_flat_roof = random.chance(0.25F);
  return style;
}

void add_house(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, float width, float depth) {
  const float top = static_cast<float>(style.storeys) * style.storey_m;
  add_wall(builder, random, style, {{0, 0, 0}, {1, 0, 0}}, width, true);
  add_wall(builder, random, style, {{width, depth, 0}, {-1, 0, 0}}, width, false);
  add_wall(builder, random, style, {{width, 0, 0}, {0, 1, 0}}, depth, false);
  add_wall(builder, random, style, {{0, depth, 0}, {0, -1, 0}}, depth, false);
  if (style.has_flat_roof) {
    add_flat_roof(builder, random, style, width, depth, top);
  } else {
    add_gable_roof(builder, random, style, width, depth, top);
  }
}

}  // namespace cmap
