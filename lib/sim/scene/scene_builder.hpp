#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

#include "scene/scene_data.hpp"

namespace cmap {

/// Collects the triangles of a scene. Coordinates are relative to `frame`, which places what is added next.
/// Quads and polygons run counter-clockwise seen from outside.
class SceneBuilder {
 public:
  SceneMesh mesh;
  Eigen::Isometry3f frame = Eigen::Isometry3f::Identity();

  /// `surface` in the coordinates of the frame.
  std::uint32_t add(Surface surface);

  void triangle(std::uint32_t surface, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);
  void quad(std::uint32_t surface, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
            const Eigen::Vector3f& d);

  /// All six sides of an axis-aligned box, each with a surface of its own, so that textures lie in its sides.
  void box(const Surface& surface, const Eigen::Vector3f& low, const Eigen::Vector3f& high);

  /// Side and top of a tapering cylinder (a cone's frustum) from `base` to `top`.
  void cylinder(std::uint32_t surface, const Eigen::Vector3f& base, const Eigen::Vector3f& top, float base_radius,
                float top_radius, int sides);

  /// Builds the ray caster.
  Scene finish();

 private:
  std::uint32_t vertex(const Eigen::Vector3f& point);
};

/// A frame at `position` whose x axis points along `heading_rad` from the world's, z up.
Eigen::Isometry3f placed_at(const Eigen::Vector3f& position, float heading_rad);

}  // namespace cmap
