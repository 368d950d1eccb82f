#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/sim/scene.hpp"
#include "scene/ray_caster.hpp"
#include "scene/surface.hpp"

namespace cmap {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles relative to an origin; surfaces say how they look.
struct SceneMesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Array<Eigen::Vector3f> vertices;
  Array<Triangle> triangles;
  Array<std::uint32_t> surface_of;  ///< of every triangle
  std::vector<Surface> surfaces;
  Lighting lighting = Lighting::kSun;
  std::function<double(double, double)> ground_height_m;  ///< of world x and y
  std::vector<SceneRoute> routes;
  /// Color of a point of a triangle, in place of the surface's texture: meshes that bring their own colors.
  std::function<RgbF(std::uint32_t triangle, const Eigen::Vector3f& point)> own_color;
};

/// A point of a surface, relative to the scene's origin.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Eigen::Vector3f position, normal;  ///< normal as the triangle is wound
};

struct PlaneHit {
  double distance;
  Eigen::Vector3f normal;  ///< unit, as the triangle is wound
};

struct SceneData {
  explicit SceneData(SceneMesh parts);

  SceneMesh mesh;
  RayCaster caster;
  Box3d bounds;

  /// Where a ray meets the plane of a triangle, in double: Embree's own distance is a float, and coarse at grazing
  /// angles. The direction may have any length; the distance is in units of it.
  PlaneHit meet(std::uint32_t triangle, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Unit, as the triangle is wound.
  Eigen::Vector3f normal_of(std::uint32_t triangle) const;
  const Surface& surface(std::uint32_t triangle) const { return mesh.surfaces[mesh.surface_of[triangle]]; }

  /// The ray from a point to the sun; none where no light could arrive anyway.
  std::optional<Ray> shadow_ray(const SurfacePoint& point) const;
  /// Color with the light on it; `in_shadow` as the shadow ray found it.
  RgbF color(const SurfacePoint& point, bool in_shadow) const;
  /// Both in one.
  RgbF color(const SurfacePoint& point) const;
};

}  // namespace cmap
