#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/indoor_room.hpp"

namespace cmap {
namespace {

Surface look(Material material, const RgbF& base, SceneRandom& random) {
  Surface surface;
  surface.material = material;
  surface.base = base;
  surface.seed = random.bits();
  return surface;
}

RgbF fabric_color(SceneRandom& random) {
  constexpr std::array<RgbF, 5> kColors = {{{0.22F, 0.30F, 0.44F},
                                            {0.50F, 0.22F, 0.20F},
                                            {0.28F, 0.38F, 0.28F},
                                            {0.24F, 0.24F, 0.26F},
                                            {0.62F, 0.50F, 0.32F}}};
  return kColors[static_cast<std::size_t>(random.below(5))];
}
RgbF wood_color(SceneRandom& random) {
  constexpr std::array<RgbF, 4> kColors = {
      {{0.66F, 0.50F, 0.34F}, {0.48F, 0.33F, 0.22F}, {0.78F, 0.70F, 0.58F}, {0.36F, 0.26F, 0.20F}}};
  return kColors[static_cast<std::size_t>(random.below(4))];
}

/// Runs `add` in a frame at (x, y) of the current one.
template <class Add>
void at_place(SceneBuilder& builder, float x, float y, float heading_rad, Add&& add) {
  const Eigen::Isometry3f outer = builder.frame;
  builder.frame = outer * placed_at({x, y, 0.0F}, heading_rad);
  add();
  builder.frame = outer;
}

void add_chair(SceneBuilder& builder, SceneRandom& random) {
  const Surface cloth = look(Material::kFabric, fabric_color(random), random);
  const std::uint32_t metal = builder.add(look(Material::kMetal, {0.30F, 0.30F, 0.32F}, random));
  builder.box(cloth, {-0.24F, -0.24F, 0.43F}, {0.24F, 0.24F, 0.50F});
  builder.box(cloth, {-0.22F, -0.27F, 0.58F}, {0.22F, -0.22F, 1.0F});
  builder.cylinder(metal, {0, 0, 0.08F}, {0, 0, 0.43F}, 0.03F, 0.03F, 8);
  for (int i = 0; i < 5; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / 5.0F;
    builder.cylinder(metal, {0.3F * std::cos(angle), 0.3F * std::sin(angle), 0.03F}, {0, 0, 0.12F}, 0.025F, 0.025F, 5);
  }
}

void add_table(SceneBuilder& builder, SceneRandom& random, float width, float depth) {
  const Surface wood = look(Material::kWood, wood_color(random), random);
  builder.box(wood, {-0.5F * width, -0.5F * depth, 0.71F}, {0.5F * width, 0.5F * depth, 0.75F});
  const std::uint32_t metal = builder.add(look(Material::kMetal, {0.40F, 0.41F, 0.42F}, random));
  for (const float x : {-0.45F, 0.45F}) {
    for (const float y : {-0.42F, 0.42F})
      builder.cylinder(metal, {x * width, y * depth, 0}, {x * width, y * depth, 0.71F}, 0.025F, 0.025F, 8);
  }
}

/// The one who sits there looks along y.
void add_desk(SceneBuilder& builder, SceneRandom& random) {
  add_table(builder, random, 1.6F, 0.75F);
  const Surface screen = look(Material::kScreen, {}, random);
  for (const float x : {-0.3F, 0.3F}) {
    if (x > 0.0F && random.chance(0.4F)) continue;
    builder.box(screen, {x - 0.26F, 0.16F, 0.85F}, {x + 0.26F, 0.19F, 1.18F});
    builder.box(look(Material::kMetal, {0.2F, 0.2F, 0.2F}, random), {x - 0.03F, 0.17F, 0.75F},
                {x + 0.03F, 0.2F, 0.86F});
  }
  builder.box(look(Material::kScreen, {}, random), {-0.25F, -0.2F, 0.75F}, {0.2F, -0.06F, 0.77F});
  for (int i = 0; i < 3; ++i) {  // papers and books
    const float x = random.between(-0.75F, 0.5F), y = random.between(-0.33F, 0.05F);
    builder.box(look(Material::kPicture, {}, random), {x, y, 0.75F},
                {x + 0.21F, y + 0.28F, 0.76F + random.between(0.0F, 0.06F)});
  }
  builder.box(look(Material::kWood, wood_color(random), random), {0.35F, -0.3F, 0.05F}, {0.75F, 0.25F, 0.62F});
  at_place(builder, random.between(-0.25F, 0.15F), -0.65F, random.between(-0.6F, 0.6F),
           [&] { add_chair(builder, random); });
}

/// Back at y = 0, books toward -y.
void add_bookcase(SceneBuilder& builder, SceneRandom& random, float width) {
  builder.box(look(Material::kWood, wood_color(random), random), {0, -0.30F, 0}, {width, 0, 2.0F});
  Surface books = look(Material::kBooks, wood_color(random), random);
  books.origin = {0.0F, -0.305F, 0.05F};
  books.u_axis = Eigen::Vector3f::UnitX();
  books.v_axis = Eigen::Vector3f::UnitZ();
  books.width = width;
  books.height = 1.9F;
  builder.quad(builder.add(books), {0, -0.305F, 0.05F}, {width, -0.305F, 0.05F}, {width, -0.305F, 1.95F},
               {0, -0.305F, 1.95F});
}

void add_cabinet(SceneBuilder& builder, SceneRandom& random) {
  builder.box(look(Material::kMetal, {0.62F, 0.64F, 0.64F}, random), {0, -0.45F, 0}, {0.9F, 0, 1.25F});
  for (int i = 0; i < 4; ++i) {
    const float z = 0.05F + 0.3F * static_cast<float>(i);
    builder.box(look(Material::kMetal, {0.55F, 0.58F, 0.60F}, random), {0.03F, -0.47F, z}, {0.87F, -0.45F, z + 0.27F});
  }
  builder.box(look(Material::kPicture, {}, random), {0.1F, -0.35F, 1.25F},
              {0.5F, -0.1F, 1.25F + random.between(0.1F, 0.3F)});
}

void add_sofa(SceneBuilder& builder, SceneRandom& random) {
  const Surface cloth = look(Material::kFabric, fabric_color(random), random);
  builder.box(cloth, {-0.95F, -0.85F, 0.12F}, {0.95F, 0, 0.42F});
  builder.box(cloth, {-0.95F, -0.22F, 0.42F}, {0.95F, 0, 0.85F});
  builder.box(cloth, {-1.1F, -0.85F, 0.12F}, {-0.95F, 0, 0.62F});
  builder.box(cloth, {0.95F, -0.85F, 0.12F}, {1.1F, 0, 0.62F});
  for (const float x : {-0.6F, 0.55F}) {
    builder.box(look(Material::kPicture, {}, random), {x - 0.2F, -0.36F, 0.43F}, {x + 0.2F, -0.23F, 0.80F});
  }
}

void add_office(SceneBuilder& builder, SceneRandom& random, const Room& room, float furniture) {
  const int desks = std::max(1, static_cast<int>(furniture * room.width / 2.2F));
  for (int i = 0; i < desks; ++i) {
    const float x = room.width * (static_cast<float>(i) + 0.5F) / static_cast<float>(desks);
    at_place(builder, x, room.depth - 0.85F, random.between(-0.04F, 0.04F), [&] { add_desk(builder, random); });
  }
  at_place(builder, 0.12F, 0.5F * room.depth + 0.3F, 0.5F * std::numbers::pi_v<float>,
           [&] { add_bookcase(builder, random, 1.4F); });
  at_place(builder, room.width - 0.12F, 0.5F * room.depth + 0.3F, -0.5F * std::numbers::pi_v<float>,
           [&] { add_cabinet(builder, random); });
}

void add_meeting_room(SceneBuilder& builder, SceneRandom& random, const Room& room) {
  const float length = std::min(2.6F, room.width - 2.4F);
  at_place(builder, 0.5F * room.width, 0.55F * room.depth, 0.0F, [&] {
    add_table(builder, random, length, 1.2F);
    const int seats = std::max(1, static_cast<int>(length / 0.8F));
    for (int i = 0; i < seats; ++i) {
      const float x = length * ((static_cast<float>(i) + 0.5F) / static_cast<float>(seats) - 0.5F);
      at_place(builder, x, -0.85F, random.between(-0.3F, 0.3F), [&] { add_chair(builder, random); });
      at_place(builder, x, 0.85F, std::numbers::pi_v<float> + random.between(-0.3F, 0.3F),
               [&] { add_chair(builder, random); });
    }
    builder.box(look(Material::kPicture, {}, random), {-0.4F, -0.2F, 0.75F}, {-0.1F, 0.2F, 0.76F});
    builder.box(look(Material::kScreen, {}, random), {0.2F, -0.1F, 0.75F}, {0.55F, 0.15F, 0.77F});
  });
  builder.box(look(Material::kScreen, {}, random), {0.10F, 0.5F * room.depth - 0.8F, 0.9F},
              {0.16F, 0.5F * room.depth + 0.8F, 1.9F});
}

void add_lounge(SceneBuilder& builder, SceneRandom& random, const Room& room) {
  at_place(builder, 0.5F * room.width, room.depth - 0.35F, 0.0F, [&] { add_sofa(builder, random); });
  at_place(builder, room.width - 0.3F, 0.5F * room.depth, -0.5F * std::numbers::pi_v<float>,
           [&] { add_sofa(builder, random); });
  at_place(builder, 0.5F * room.width, room.depth - 1.9F, 0.3F, [&] { add_table(builder, random, 0.9F, 0.6F); });
  at_place(builder, 0.12F, 0.5F * room.depth, 0.5F * std::numbers::pi_v<float>,
           [&] { add_bookcase(builder, random, 1.2F); });
}

}  // namespace

void furnish(SceneBuilder& builder, SceneRandom& random, const Room& room, float furniture) {
  const float dice = random.unit();
  if (dice < 0.6F || room.width < 3.6F) {
    add_office(builder, random, room, furniture);
  } else if (dice < 0.82F) {
    add_meeting_room(builder, random, room);
  } else {
    add_lounge(builder, random, room);
  }
  if (random.chance(0.7F)) add_pot_plant(builder, random, {0.5F, room.depth - 0.5F, 0.0F});
}

}  // namespace cmap
