#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/sim/capture_simulation.hpp"

namespace cmap {
namespace {

Scene make_town_of(const SceneChoice& choice) {
  TownOptions options = choice.town;
  options.seed = static_cast<std::uint64_t>(choice.seed);
  return make_town(options);
}

Scene make_indoor_of(const SceneChoice& choice) {
  IndoorOptions options = choice.indoor;
  options.seed = static_cast<std::uint64_t>(choice.seed);
  return make_indoor(options);
}

Scene make_aerial_of(const SceneChoice& choice) {
  AerialOptions options = choice.aerial;
  options.seed = static_cast<std::uint64_t>(choice.seed);
  return make_aerial(options);
}

/// The way of the scene, raised, and once around with the overlap if it is closed.
Route scene_route(const Scene& scene, const RouteChoice& choice) {
  const SceneRoute& way = scene.route(choice.name);
  Route route;
  for (const Eigen::Vector3d& p : way.points) route.emplace_back(p + choice.height_m * Eigen::Vector3d::UnitZ());
  if (!way.closed) return route;
  double beyond = 0.0;
  for (std::size_t i = 0; i < way.points.size() && beyond <= choice.overlap_m; ++i) {
    route.push_back(route[i]);
    if (i + 1 < way.points.size()) beyond += (route[i + 1] - route[i]).norm();
  }
  return route;
}

Route corners_of(const RouteChoice& choice) {
  const Eigen::Vector3d start(choice.start_m.x(), choice.start_m.y(), 0.0);
  const bool has_box = (choice.max_m.array() > choice.min_m.array()).all();
  switch (choice.kind) {
    case RouteKind::kStraight:
      if (!(choice.length_m > 0.0)) throw UsageError("route: a straight way needs a length_m");
      return straight_route(start, choice.heading_deg, choice.begin_m + choice.length_m);
    case RouteKind::kBlock:
    case RouteKind::kSurvey:
      if (!has_box) throw UsageError("route: max_m must be above min_m");
      return choice.kind == RouteKind::kBlock ? block_route(choice.min_m, choice.max_m, 0.0, choice.overlap_m)
                                              : survey_route(choice.min_m, choice.max_m, 0.0, choice.line_distance_m);
    default:
      return {start};
  }
}

/// The way without its first begin_m, and not longer than length_m.
Route cut(const Route& route, double begin_m, double length_m) {
  Route part;
  double done = 0.0;
  const double end_m = length_m > 0.0 ? begin_m + length_m : 1e300;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double step = (route[i] - route[i - 1]).norm();
    if (step == 0.0) continue;
    const double from = std::clamp((begin_m - done) / step, 0.0, 1.0), to = std::clamp((end_m - done) / step, 0.0, 1.0);
    done += step;
    if (from >= to) continue;
    const Eigen::Vector3d way = route[i] - route[i - 1];
    if (part.empty()) part.push_back(route[i - 1] + from * way);
    part.push_back(route[i - 1] + to * way);
  }
  if (part.empty()) throw UsageError(fmt::format("route: begin_m {} is beyond its end, {:.1f} m", begin_m, done));
  return part;
}

}  // namespace

Scene make_scene(const SceneChoice& choice) {
  switch (choice.kind) {
    case SceneKind::kTown:
      return make_town_of(choice);
    case SceneKind::kIndoor:
      return make_indoor_of(choice);
    case SceneKind::kAerial:
      return make_aerial_of(choice);
    case SceneKind::kMesh:
      break;
  }
  return read_mesh_scene(choice.mesh);
}

Route make_route(const Scene& scene, const RouteChoice& choice) {
  if (choice.kind == RouteKind::kScene) return cut(scene_route(scene, choice), choice.begin_m, choice.length_m);
  const auto ground = [&](double x, double y) { return scene.ground_height_m(x, y); };
  if (choice.kind == RouteKind::kSurvey) {
    // An aircraft keeps its altitude above the middle of the box.
    const Eigen::Vector2d middle = 0.5 * (choice.min_m + choice.max_m);
    const double z = ground(middle.x(), middle.y()) + choice.height_m;
    Route route = corners_of(choice);
    for (Eigen::Vector3d& corner : route) corner.z() = z;
    return cut(route, choice.begin_m, choice.length_m);
  }
  const Route route = draped_route(corners_of(choice), ground, choice.height_m);
  return choice.kind == RouteKind::kHover ? route : cut(route, choice.begin_m, choice.length_m);
}

}  // namespace cmap
