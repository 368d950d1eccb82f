#include "scene/indoor_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/facade.hpp"
#include "scene/scene_objects.hpp"

namespace cmap {
namespace {

constexpr float kDoorWidth_m = 0.95F, kDoorHeight_m = 2.1F;

RgbF wall_color(SceneRandom& random) {
  constexpr std::array<RgbF, 7> kColors = {{{0.86F, 0.84F, 0.78F},
                                            {0.74F, 0.82F, 0.84F},
                                            {0.80F, 0.84F, 0.72F},
                                            {0.88F, 0.78F, 0.68F},
                                            {0.82F, 0.80F, 0.86F},
                                            {0.90F, 0.88F, 0.84F},
                                            {0.72F, 0.77F, 0.80F}}};
  return kColors[static_cast<std::size_t>(random.below(static_cast<int>(kColors.size())))];
}

Surface look(Material material, const RgbF& base, std::uint32_t seed) {
  Surface surface;
  surface.material = material;
  surface.base = base;
  surface.seed = seed;
  return surface;
}

void add_skirting(SceneBuilder& builder, const WallPlane& wall, float u0, float u1) {
  if (u1 > u0) add_ledge(builder, wall, {u0, u1, 0.0F, 0.09F}, 0.015F, look(Material::kWood, {0.42F, 0.31F, 0.22F}, 5));
}

/// A wall face with a hole for the door.
void add_door_wall(SceneBuilder& builder, const WallPlane& wall, float length, float height, const WallRect& door,
                   const Surface& paint) {
  const std::uint32_t surface = builder.add(on_wall(wall, paint));
  const auto patch = [&](float u0, float u1, float v0, float v1) {
    builder.quad(surface, wall.at(u0, v0), wall.at(u1, v0), wall.at(u1, v1), wall.at(u0, v1));
  };
  patch(0.0F, door.u0, 0.0F, height);
  patch(door.u0, door.u1, door.v1, height);
  patch(door.u1, length, 0.0F, height);
  add_skirting(builder, wall, 0.0F, door.u0 - 0.08F);
  add_skirting(builder, wall, door.u1 + 0.08F, length);
  const Surface frame = look(Material::kPlain, {0.55F, 0.57F, 0.58F}, 9);
  add_ledge(builder, wall, {door.u0 - 0.08F, door.u0, 0.0F, door.v1 + 0.08F}, 0.02F, frame);
  add_ledge(builder, wall, {door.u1, door.u1 + 0.08F, 0.0F, door.v1 + 0.08F}, 0.02F, frame);
  add_ledge(builder, wall, {door.u0, door.u1, door.v1, door.v1 + 0.08F}, 0.02F, frame);
}

/// Jambs and lintel, and the door: shut, or open into the room.
void add_door(SceneBuilder& builder, SceneRandom& random, float x0, float x1) {
  const std::uint32_t jamb = builder.add(look(Material::kPlain, {0.55F, 0.57F, 0.58F}, 9));
  const float h = kDoorHeight_m;
  builder.quad(jamb, {x0, 0, 0}, {x0, kWall_m, 0}, {x0, kWall_m, h}, {x0, 0, h});
  builder.quad(jamb, {x1, kWall_m, 0}, {x1, 0, 0}, {x1, 0, h}, {x1, kWall_m, h});
  builder.quad(jamb, {x0, 0, h}, {x0, kWall_m, h}, {x1, kWall_m, h}, {x1, 0, h});
  constexpr std::array<RgbF, 4> kColors = {
      {{0.56F, 0.40F, 0.26F}, {0.30F, 0.42F, 0.50F}, {0.68F, 0.66F, 0.62F}, {0.50F, 0.24F, 0.20F}}};
  Surface leaf = look(Material::kDoor, kColors[static_cast<std::size_t>(random.below(4))], random.bits());
  if (random.chance(0.45F)) {
    builder.box(leaf, {x0, 0.05F, 0.01F}, {x1, 0.09F, h});
  } else {
    builder.box(leaf, {x1 - 0.04F, kWall_m, 0.01F}, {x1, kWall_m + kDoorWidth_m, h});
  }
}

void add_windows(SceneBuilder& builder, SceneRandom& random, const WallPlane& wall, float length, float height,
                 const Surface& paint) {
  const std::uint32_t surface = builder.add(on_wall(wall, paint));
  const int n = std::max(1, static_cast<int>(length / 2.1F));
  const float pitch = length / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float u0 = static_cast<float>(i) * pitch;
    Surface glass = look(Material::kWindow, {0.90F, 0.90F, 0.90F}, random.bits());
    glass.accent = {1.5F, 1.6F, 1.7F};  // daylight
    const WallRect cell{u0, u0 + pitch, 0.0F, height}, opening{u0 + 0.3F, u0 + pitch - 0.3F, 0.95F, height - 0.35F};
    add_opening(builder, surface, wall, cell, opening, 0.12F, glass);
    add_ledge(builder, wall, {opening.u0 - 0.1F, opening.u1 + 0.1F, 0.91F, 0.95F}, 0.2F,
              look(Material::kStone, {0.72F, 0.70F, 0.68F}, 3));
    const Surface radiator = look(Material::kMetal, {0.85F, 0.85F, 0.83F}, random.bits());
    for (float u = opening.u0; u < opening.u1 - 0.1F; u += 0.12F) {
      add_ledge(builder, wall, {u, u + 0.09F, 0.15F, 0.75F}, 0.1F, radiator);
    }
  }
  add_skirting(builder, wall, 0.0F, length);
}

void add_plain_wall(SceneBuilder& builder, SceneRandom& random, const WallPlane& wall, float length, float height,
                    const Surface& paint, bool has_pictures) {
  add_panel(builder, wall, {0.0F, length, 0.0F, height}, 0.0F, paint);
  add_skirting(builder, wall, 0.0F, length);
  if (has_pictures) hang_pictures(builder, random, wall.start, wall.along, 0.3F, length - 0.3F);
}

}  // namespace

void hang_pictures(SceneBuilder& builder, SceneRandom& random, const Eigen::Vector3f& start,
                   const Eigen::Vector3f& along, float u0, float u1) {
  const WallPlane wall{start, along};
  for (float u = u0 + random.between(0.0F, 0.8F); u < u1 - 0.5F;) {
    const float width = std::min(random.between(0.4F, 1.5F), u1 - u), height = random.between(0.4F, 1.0F);
    const float middle = random.between(1.45F, 1.7F);
    Surface picture = look(Material::kPicture, {0.5F, 0.5F, 0.5F}, random.bits());
    add_ledge(builder, wall, {u, u + width, middle - 0.5F * height, middle + 0.5F * height}, 0.03F, picture);
    u += width + random.between(0.35F, 1.6F);
  }
}

void add_pot_plant(SceneBuilder& builder, SceneRandom& random, const Eigen::Vector3f& at) {
  const Eigen::Isometry3f outer = builder.frame;
  builder.cylinder(builder.add(look(Material::kPlain, {0.60F, 0.36F, 0.26F}, random.bits())), at,
                   at + Eigen::Vector3f(0, 0, 0.38F), 0.16F, 0.22F, 14);
  builder.frame.translation() = outer * Eigen::Vector3f(at + Eigen::Vector3f(0, 0, 0.35F));
  add_tree(builder, random, random.between(1.0F, 1.5F), 0.13F, 260);
  builder.frame = outer;
}

void add_room(SceneBuilder& builder, SceneRandom& random, const Room& room, float furniture) {
  const float w = room.width, d = room.depth, h = room.height, t = kWall_m, half = 0.5F * t;
  const Surface paint = look(Material::kPaint, wall_color(random), random.bits());
  Surface carpet =
      look(random.chance(0.7F) ? Material::kCarpet : Material::kFloorTiles, {0.36F, 0.40F, 0.47F}, random.bits());
  const float warmth = random.between(-0.12F, 0.14F);
  carpet.base = {0.40F + warmth, 0.39F, 0.42F - warmth};
  carpet.accent = {0.24F + warmth, 0.26F, 0.30F};
  builder.quad(builder.add(carpet), {0, 0, 0}, {w, 0, 0}, {w, d, 0}, {0, d, 0});
  builder.quad(builder.add(look(Material::kCeiling, {0.88F, 0.88F, 0.86F}, random.bits())), {0, 0, h}, {0, d, h},
               {w, d, h}, {w, 0, h});

  const float x0 = random.between(room.door_from, std::max(room.door_from, room.door_to - kDoorWidth_m));
  const float x1 = x0 + kDoorWidth_m;
  const Surface corridor_paint = look(Material::kPaint, {0.86F, 0.84F, 0.79F}, 17);
  const WallPlane in_corridor{{0, 0, 0}, {1, 0, 0}};
  add_door_wall(builder, in_corridor, w, h, {x0, x1, 0.0F, kDoorHeight_m}, corridor_paint);
  hang_pictures(builder, random, in_corridor.start, in_corridor.along, room.door_from + 0.1F, x0 - 0.15F);
  hang_pictures(builder, random, in_corridor.start, in_corridor.along, x1 + 0.15F, room.door_to - 0.1F);
  add_door_wall(builder, {{w - half, t, 0}, {-1, 0, 0}}, w - t, h, {w - half - x1, w - half - x0, 0.0F, kDoorHeight_m},
                paint);
  add_door(builder, random, x0, x1);

  const float y1 = d - half;
  add_plain_wall(builder, random, {{half, t, 0}, {0, 1, 0}}, y1 - t, h, paint, true);
  add_plain_wall(builder, random, {{w - half, y1, 0}, {0, -1, 0}}, y1 - t, h, paint, true);
  const WallPlane far_wall{{half, y1, 0}, {1, 0, 0}};
  if (room.has_windows) {
    add_windows(builder, random, far_wall, w - t, h, paint);
  } else {
    add_plain_wall(builder, random, far_wall, w - t, h, paint, true);
  }
  if (furniture > 0.0F) furnish(builder, random, room, furniture);
}

}  // namespace cmap
