#include "cmap/sim/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "scene/light.hpp"
#include "scene/scene_data.hpp"

namespace cmap {
namespace {

Box3d bounds_of(const SceneMesh& mesh) {
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return {mesh.origin + low.cast<double>(), mesh.origin + high.cast<double>()};
}

SurfaceHit surface_hit(const SceneData& data, const SurfacePoint& point, double distance_m,
                       const Eigen::Vector3d& direction) {
  SurfaceHit hit;
  hit.distance_m = distance_m;
  hit.normal = point.normal.cast<double>().dot(direction) > 0.0 ? Eigen::Vector3f(-point.normal) : point.normal;
  hit.reflectivity = reflectivity(data.surface(point.triangle), point.position);
  return hit;
}

/// What a ray meets first.
struct Met {
  SurfacePoint point;
  SurfaceHit hit;
};

std::optional<Met> first_met(const SceneData& data, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_distance_m) {
  const Eigen::Vector3d local = origin - data.mesh.origin;
  const std::uint32_t triangle =
      data.caster.first({local.cast<float>(), direction.cast<float>(), static_cast<float>(max_distance_m)});
  if (triangle == RayCaster::kNone) return std::nullopt;
  const PlaneHit plane = data.meet(triangle, local, direction);
  const SurfacePoint point{triangle, (local + plane.distance * direction).cast<float>(), plane.normal};
  return Met{point, surface_hit(data, point, plane.distance, direction)};
}

}  // namespace

SceneData::SceneData(SceneMesh parts)
    : mesh(std::move(parts)), caster(mesh.vertices, mesh.triangles), bounds(bounds_of(mesh)) {}

PlaneHit SceneData::meet(std::uint32_t triangle, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction) const {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Eigen::Vector3d n = (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
  return {std::max(0.0, n.dot(a - origin) / n.dot(direction)), n.cast<float>().normalized()};
}

Eigen::Vector3f SceneData::normal_of(std::uint32_t triangle) const {
  return meet(triangle, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()).normal;
}

std::optional<Ray> SceneData::shadow_ray(const SurfacePoint& point) const {
  if (mesh.lighting != Lighting::kSun) return std::nullopt;
  return sun_ray(surface(point.triangle), point.position, point.normal);
}

RgbF SceneData::color(const SurfacePoint& point, bool in_shadow) const {
  const Surface& patch = surface(point.triangle);
  const RgbF texture =
      mesh.own_color ? mesh.own_color(point.triangle, point.position) : texture_color(patch, point.position);
  return lit(texture, mesh.lighting, patch, point.position, point.normal, in_shadow);
}

RgbF SceneData::color(const SurfacePoint& point) const {
  const std::optional<Ray> to_sun = shadow_ray(point);
  return color(point, !to_sun || caster.is_blocked(*to_sun));
}

Scene::Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}

std::optional<SurfaceHit> Scene::probe(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                       double max_distance_m) const {
  const auto met = first_met(*data_, origin, direction, max_distance_m);
  return met ? std::optional(met->hit) : std::nullopt;
}

std::optional<SceneHit> Scene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    double max_distance_m) const {
  const auto met = first_met(*data_, origin, direction, max_distance_m);
  return met ? std::optional(SceneHit{met->hit, data_->color(met->point)}) : std::nullopt;
}

RgbF Scene::sky(const Eigen::Vector3d& direction) const { return sky_color(direction.cast<float>()); }

Box3d Scene::bounds() const { return data_->bounds; }

double Scene::ground_height_m(double x, double y) const {
  if (data_->mesh.ground_height_m) return data_->mesh.ground_height_m(x, y);
  constexpr double kStep_m = 1e-3;
  double z = data_->bounds.max.z() + 1.0, lowest = data_->bounds.min.z();
  while (const auto hit = probe({x, y, z}, -Eigen::Vector3d::UnitZ(), z - data_->bounds.min.z() + 1.0)) {
    lowest = z - hit->distance_m;
    z = lowest - kStep_m;
  }
  return lowest;
}

const std::vector<SceneRoute>& Scene::routes() const { return data_->mesh.routes; }

const SceneRoute& Scene::route(std::string_view name) const {
  std::vector<std::string> names;
  for (const SceneRoute& route : routes()) {
    if (route.name == name) return route;
    names.push_back(route.name);
  }
  throw UsageError(fmt::format("the scene has no route '{}'; it has: {}", name,
                               names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace cmap
