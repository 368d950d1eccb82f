#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene_objects.hpp"

namespace cmap {
namespace {

Eigen::Vector3f random_direction(SceneRandom& random) {
  const float z = random.between(-1.0F, 1.0F), angle = random.between(0.0F, 2.0F * std::numbers::pi_v<float>);
  const float r = std::sqrt(std::max(0.0F, 1.0F - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// A leaf (really a twig with leaves): a lozenge that faces roughly outward.
void add_leaf(SceneBuilder& builder, SceneRandom& random, std::uint32_t surface, const Eigen::Vector3f& at,
              const Eigen::Vector3f& outward, float size) {
  const Eigen::Vector3f normal = (outward + 0.9F * random_direction(random)).normalized();
  const Eigen::Vector3f u = normal.cross(random_direction(random)).normalized() * (0.5F * size);
  const Eigen::Vector3f v = normal.cross(u) * random.between(0.6F, 1.1F);
  builder.quad(surface, at - u, at - v, at + u, at + v);
}

Surface leaf_look(SceneRandom& random, const Eigen::Vector3f& center) {
  Surface look;
  look.material = Material::kLeaves;
  look.origin = center;
  const float hue = random.unit();
  look.base = {0.22F + 0.16F * hue, 0.40F + 0.08F * random.unit(), 0.12F + 0.06F * random.unit()};
  look.accent = {0.52F, 0.56F, 0.20F};
  look.seed = random.bits();
  return look;
}

Surface bark_look(SceneRandom& random) {
  Surface look;
  look.material = Material::kBark;
  look.base = {0.38F, 0.30F, 0.23F};
  look.seed = random.bits();
  return look;
}

/// A clump of leaves within an ellipsoid, most of them near its surface.
void add_clump(SceneBuilder& builder, SceneRandom& random, std::uint32_t surface, const Eigen::Vector3f& center,
               const Eigen::Vector3f& radii, float leaf_m, int leaves) {
  for (int i = 0; i < leaves; ++i) {
    const Eigen::Vector3f direction = random_direction(random);
    const float depth = 1.0F - 0.45F * random.unit() * random.unit();
    add_leaf(builder, random, surface, center + depth * radii.cwiseProduct(direction), direction,
             leaf_m * random.between(0.7F, 1.3F));
  }
}

}  // namespace

void add_tree(SceneBuilder& builder, SceneRandom& random, float height_m, float leaf_m, int leaves) {
  const std::uint32_t bark = builder.add(bark_look(random));
  const float trunk = 0.35F * height_m, radius = 0.022F * height_m + 0.04F;
  const Eigen::Vector3f lean(random.between(-0.03F, 0.03F) * height_m, random.between(-0.03F, 0.03F) * height_m, trunk);
  builder.cylinder(bark, {0, 0, -0.4F}, lean, 1.25F * radius, 0.8F * radius, 9);
  const Eigen::Vector3f center = lean + Eigen::Vector3f(0, 0, 0.30F * height_m);
  const std::uint32_t surface = builder.add(leaf_look(random, center));
  constexpr int kClumps = 7;
  const float spread = 0.20F * height_m;
  for (int i = 0; i < kClumps; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.6F * random.unit()) / kClumps;
    const float up = i == 0 ? 0.17F * height_m : random.between(-0.12F, 0.12F) * height_m;
    const float out = i == 0 ? 0.0F : spread * random.between(0.6F, 1.0F);
    const Eigen::Vector3f at = center + Eigen::Vector3f(out * std::cos(angle), out * std::sin(angle), up);
    builder.cylinder(bark, lean, at, 0.45F * radius, 0.15F * radius, 5);
    const float size = random.between(0.14F, 0.19F) * height_m;
    add_clump(builder, random, surface, at, {size, size, 0.85F * size}, leaf_m, leaves / kClumps);
  }
}

void add_fir(SceneBuilder& builder, SceneRandom& random, float height_m, int leaves) {
  const std::uint32_t bark = builder.add(bark_look(random));
  builder.cylinder(bark, {0, 0, -0.4F}, {0, 0, 0.95F * height_m}, 0.02F * height_m, 0.004F * height_m, 7);
  Surface look = leaf_look(random, {0, 0, 0.25F * height_m});
  look.base = {0.13F, 0.27F + 0.06F * random.unit(), 0.15F};
  look.accent = {0.26F, 0.38F, 0.20F};
  const std::uint32_t surface = builder.add(look);
  for (int i = 0; i < leaves; ++i) {
    // Dense at the bottom, where the cone is wide.
    const float up = 1.0F - std::sqrt(random.unit());
    const float layer = std::fmod(up * 9.0F, 1.0F);
    const float radius =
        height_m * 0.2F * (1.0F - up) * (1.15F - 0.45F * layer) * std::sqrt(random.between(0.5F, 1.0F));
    const float angle = random.between(0.0F, 2.0F * std::numbers::pi_v<float>);
    const Eigen::Vector3f outward(std::cos(angle), std::sin(angle), 0.5F);
    add_leaf(builder, random, surface, {radius * outward.x(), radius * outward.y(), height_m * (0.12F + 0.88F * up)},
             outward, 0.05F * height_m);
  }
}

void add_hedge(SceneBuilder& builder, SceneRandom& random, float length_m, float height_m) {
  for (float x = 0.5F; x < length_m; x += 0.9F) {
    const Eigen::Vector3f center(x, 0, 0.5F * height_m);
    const std::uint32_t surface = builder.add(leaf_look(random, center));
    add_clump(builder, random, surface, center, {0.65F, 0.4F, 0.5F * height_m}, 0.2F, 130);
  }
}

}  // namespace cmap
