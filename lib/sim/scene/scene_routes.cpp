#include "scene/scene_routes.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

constexpr double kStep_m = 0.5;

using Polyline = std::vector<Eigen::Vector2d>;

/// Replaces a corner by a quadratic Bezier curve that starts and ends `reach` away from it.
void append_corner(Polyline& line, const Eigen::Vector2d& before, const Eigen::Vector2d& corner,
                   const Eigen::Vector2d& after, double radius_m) {
  const double reach = std::min({radius_m, 0.5 * (corner - before).norm(), 0.5 * (after - corner).norm()});
  const Eigen::Vector2d from = corner + reach * (before - corner).normalized();
  const Eigen::Vector2d to = corner + reach * (after - corner).normalized();
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * reach / kStep_m)));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, s = 1.0 - t;
    line.push_back(s * s * from + 2.0 * s * t * corner + t * t * to);
  }
}

Polyline rounded(const Polyline& corners, bool closed, double radius_m) {
  const std::size_t n = corners.size();
  Polyline line;
  for (std::size_t i = 0; i < n; ++i) {
    if (!closed && (i == 0 || i + 1 == n)) {
      line.push_back(corners[i]);
    } else {
      append_corner(line, corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n], radius_m);
    }
  }
  if (closed) line.push_back(line.front());
  return line;
}

}  // namespace

SceneRoute rounded_route(std::string name, const Polyline& corners, bool closed, double radius_m,
                         const std::function<double(double, double)>& height_m) {
  SceneRoute route{std::move(name), closed, {}};
  const Polyline line = rounded(corners, closed, radius_m);
  const auto add = [&](const Eigen::Vector2d& p) { route.points.emplace_back(p.x(), p.y(), height_m(p.x(), p.y())); };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d step = line[i + 1] - line[i];
    const int parts = static_cast<int>(std::ceil(step.norm() / kStep_m));
    for (int k = 0; k < parts; ++k) add(line[i] + step * k / parts);
  }
  if (!closed) add(line.back());
  return route;
}

}  // namespace cmap
