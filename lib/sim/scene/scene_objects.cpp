#include "scene/scene_objects.hpp"

#include <array>
#include <vector>

namespace cmap {
namespace {

Surface plain(Material material, const RgbF& color, std::uint32_t seed = 0) {
  Surface surface;
  surface.material = material;
  surface.base = color;
  surface.seed = seed;
  return surface;
}

RgbF car_color(SceneRandom& random) {
  constexpr std::array<RgbF, 9> kColors = {{{0.80F, 0.81F, 0.82F},
                                            {0.16F, 0.17F, 0.19F},
                                            {0.52F, 0.54F, 0.57F},
                                            {0.62F, 0.10F, 0.10F},
                                            {0.14F, 0.25F, 0.50F},
                                            {0.88F, 0.87F, 0.84F},
                                            {0.20F, 0.38F, 0.30F},
                                            {0.80F, 0.55F, 0.12F},
                                            {0.36F, 0.30F, 0.26F}}};
  return kColors[static_cast<std::size_t>(random.below(static_cast<int>(kColors.size())))];
}

/// A convex outline in the x-z plane, swept across from -half to half; its upper points draw in by `tuck`.
struct Outline {
  std::vector<Eigen::Vector2f> points;  ///< (x, z), counter-clockwise seen from -y
  float half_width = 0.0F;
  float tuck = 0.0F;  ///< m that the highest point lies further in than the lowest
  float low = 0.0F, high = 1.0F;

  Eigen::Vector3f at(std::size_t i, float side) const {
    const Eigen::Vector2f& p = points[i % points.size()];
    const float inset = tuck * (p.y() - low) / (high - low);
    return {p.x(), side * (half_width - inset), p.y()};
  }
};

void sweep(SceneBuilder& builder, const Outline& outline, const std::vector<std::uint32_t>& edge_surfaces,
           std::uint32_t side_surface) {
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    builder.quad(edge_surfaces[i], outline.at(i, 1), outline.at(i, -1), outline.at(i + 1, -1), outline.at(i + 1, 1));
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    builder.triangle(side_surface, outline.at(0, -1), outline.at(i, -1), outline.at(i + 1, -1));
    builder.triangle(side_surface, outline.at(0, 1), outline.at(i + 1, 1), outline.at(i, 1));
  }
}

/// Front and back, above the ground, seen from -y (x to the right): hood, windscreen, roof, rear window.
Outline cabin_outline(bool is_van) {
  Outline cabin;
  cabin.points = is_van
                     ? std::vector<Eigen::Vector2f>{{-2.0F, 0.92F}, {1.15F, 0.92F}, {0.65F, 1.85F}, {-1.9F, 1.9F}}
                     : std::vector<Eigen::Vector2f>{{-1.85F, 0.86F}, {1.05F, 0.86F}, {0.25F, 1.42F}, {-1.15F, 1.45F}};
  cabin.half_width = 0.84F;
  cabin.tuck = 0.18F;
  cabin.low = cabin.points[0].y();
  cabin.high = cabin.points[3].y();
  return cabin;
}

Outline body_outline() {
  Outline body;
  body.points = {{-2.1F, 0.25F}, {2.05F, 0.25F}, {2.15F, 0.45F}, {2.1F, 0.68F},
                 {1.05F, 0.90F}, {-2.0F, 0.93F}, {-2.2F, 0.72F}};
  body.half_width = 0.88F;
  body.tuck = 0.04F;
  body.low = 0.25F;
  body.high = 0.93F;
  return body;
}

}  // namespace

void add_car(SceneBuilder& builder, SceneRandom& random) {
  const bool is_van = random.chance(0.25F);
  const std::uint32_t paint = builder.add(plain(Material::kCarPaint, car_color(random), random.bits()));
  const std::uint32_t glass = builder.add(plain(Material::kMetal, {0.13F, 0.16F, 0.19F}, random.bits()));
  const std::uint32_t rubber = builder.add(plain(Material::kPlain, {0.10F, 0.10F, 0.10F}, random.bits()));
  const std::uint32_t hub = builder.add(plain(Material::kMetal, {0.62F, 0.63F, 0.65F}, random.bits()));
  sweep(builder, body_outline(), std::vector<std::uint32_t>(7, paint), paint);
  const Outline cabin = cabin_outline(is_van);
  sweep(builder, cabin, {paint, glass, paint, glass}, glass);
  // A pillar between the side windows.
  for (const float side : {-1.0F, 1.0F}) {
    const float y0 = side * 0.845F, y1 = side * (0.845F - 0.18F);
    const float top = cabin.high;
    const Eigen::Vector3f a(-0.45F, y0, cabin.low), b(-0.30F, y0, cabin.low), c(-0.30F, y1, top), d(-0.45F, y1, top);
    builder.quad(paint, a, b, c, d);
  }
  for (const float x : {-1.35F, 1.35F}) {
    for (const float side : {-1.0F, 1.0F}) {
      builder.cylinder(rubber, {x, side * 0.66F, 0.32F}, {x, side * 0.90F, 0.32F}, 0.32F, 0.32F, 16);
      builder.cylinder(hub, {x, side * 0.88F, 0.32F}, {x, side * 0.91F, 0.32F}, 0.19F, 0.17F, 10);
    }
  }
  for (const float side : {-1.0F, 1.0F}) {
    builder.box(plain(Material::kPlain, {0.92F, 0.92F, 0.85F}), {2.08F, side * 0.62F - 0.16F, 0.52F},
                {2.16F, side * 0.62F + 0.16F, 0.66F});
    builder.box(plain(Material::kPlain, {0.70F, 0.08F, 0.08F}), {-2.21F, side * 0.66F - 0.13F, 0.58F},
                {-2.12F, side * 0.66F + 0.13F, 0.76F});
  }
  Surface plate;
  plate.material = Material::kPicture;
  plate.seed = random.bits();
  builder.box(plate, {-2.2F, -0.26F, 0.42F}, {-2.13F, 0.26F, 0.54F});
}

void add_street_lamp(SceneBuilder& builder) {
  const std::uint32_t pole = builder.add(plain(Material::kMetal, {0.30F, 0.33F, 0.34F}));
  builder.cylinder(pole, {0, 0, -0.3F}, {0, 0, 5.6F}, 0.08F, 0.05F, 10);
  builder.cylinder(pole, {0, 0, 5.5F}, {1.4F, 0, 5.9F}, 0.04F, 0.035F, 8);
  builder.box(plain(Material::kMetal, {0.45F, 0.46F, 0.47F}), {1.2F, -0.14F, 5.84F}, {1.9F, 0.14F, 5.98F});
}

void add_bench(SceneBuilder& builder, SceneRandom& random) {
  const Surface wood = plain(Material::kWood, {0.52F, 0.36F, 0.22F}, random.bits());
  for (int i = 0; i < 3; ++i) {
    const float y = -0.25F + 0.17F * static_cast<float>(i);
    builder.box(wood, {-0.8F, y, 0.42F}, {0.8F, y + 0.13F, 0.46F});
  }
  for (int i = 0; i < 2; ++i) {
    const float z = 0.58F + 0.17F * static_cast<float>(i);
    builder.box(wood, {-0.8F, 0.27F, z}, {0.8F, 0.31F, z + 0.12F});
  }
  for (const float x : {-0.65F, 0.6F}) {
    builder.box(plain(Material::kMetal, {0.25F, 0.25F, 0.26F}), {x, -0.22F, 0.0F}, {x + 0.05F, 0.3F, 0.42F});
  }
}

void add_trash_bin(SceneBuilder& builder, SceneRandom& random) {
  const RgbF color = random.chance(0.5F) ? RgbF{0.20F, 0.36F, 0.24F} : RgbF{0.38F, 0.39F, 0.41F};
  builder.cylinder(builder.add(plain(Material::kMetal, color, random.bits())), {0, 0, 0}, {0, 0, 0.95F}, 0.24F, 0.28F,
                   14);
}

void add_sign(SceneBuilder& builder, SceneRandom& random) {
  builder.cylinder(builder.add(plain(Material::kMetal, {0.55F, 0.56F, 0.57F})), {0, 0, -0.2F}, {0, 0, 2.7F}, 0.035F,
                   0.035F, 8);
  Surface face;
  face.material = Material::kPicture;
  face.seed = random.bits();
  builder.box(face, {-0.35F, -0.06F, 2.1F}, {0.35F, -0.03F, 2.7F});
}

}  // namespace cmap
