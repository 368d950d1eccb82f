#include "map/plane_map.hpp"

#include <cmath>
#include <vector>

namespace cmap {
namespace {

constexpr std::uint32_t kNone = 0;

/// The octant of a cell, and the corner that it begins at.
int child_of(const Eigen::Vector3d& point, const Eigen::Vector3d& corner, double half_m) {
  const Eigen::Vector3d from = point - corner;
  return (from.x() >= half_m ? 1 : 0) | (from.y() >= half_m ? 2 : 0) | (from.z() >= half_m ? 4 : 0);
}
Eigen::Vector3d corner_of(int child, const Eigen::Vector3d& corner, double half_m) {
  return corner + half_m * Eigen::Vector3d(child & 1, (child >> 1) & 1, child >> 2);
}

Eigen::Vector3d corner_of(const VoxelKey& key, double size_m) { return size_m * Eigen::Vector3d(key.x, key.y, key.z); }

}  // namespace

VoxelKey PlaneMap::key_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d place = (point / options_.voxel_m).array().floor();
  return {static_cast<std::int32_t>(place.x()), static_cast<std::int32_t>(place.y()),
          static_cast<std::int32_t>(place.z())};
}

void PlaneMap::add(std::span<const MapPoint> points, double path_m) {
  path_m_ = path_m;
  // Chains of the points of each root, so that a cell sees all of its points at once and can hand them on to its
  // children where they are no plane.
  std::vector<std::uint32_t> next(points.size());
  std::vector<VoxelKey> touched;
  for (std::size_t i = points.size(); i-- > 0;) {
    const VoxelKey key = key_of(points[i].position);
    Root& root = roots_[key];
    if (root.first_point == kNone) touched.push_back(key);
    next[i] = root.first_point;
    root.first_point = static_cast<std::uint32_t>(i + 1);
  }
  std::vector<MapPoint> own;
  for (const VoxelKey& key : touched) {
    Root& root = roots_[key];
    own.clear();
    for (std::uint32_t i = root.first_point; i != kNone; i = next[i - 1]) own.push_back(points[i - 1]);
    root.first_point = kNone;
    if (path_m - root.seen_at_m > options_.forget_after_m) root.cell = {};
    root.seen_at_m = path_m;
    add_to(root.cell, corner_of(key, options_.voxel_m), options_.voxel_m, 1, own);
  }
}

void PlaneMap::add_to(Cell& cell, const Eigen::Vector3d& corner, double size_m, int level,
                      std::span<const MapPoint> points) {
  const bool settled = cell.sums.n >= options_.most_points;
  if (settled && cell.is_plane) return;
  if (!settled) {
    for (const MapPoint& p : points) cell.sums.add(p.position - corner, p.variance_m2);
    const auto plane = fit_plane(cell.sums, corner, size_m, options_.plane);
    cell.is_plane = plane.has_value();
    if (plane) cell.plane = *plane;
  }
  if (cell.is_plane || level >= options_.levels) return;
  if (cell.children == nullptr) cell.children = &children_.emplace_back();
  std::array<std::vector<MapPoint>, 8> parts;
  for (const MapPoint& p : points)
    parts[static_cast<std::size_t>(child_of(p.position, corner, 0.5 * size_m))].push_back(p);
  for (int child = 0; child < 8; ++child) {
    const auto& part = parts[static_cast<std::size_t>(child)];
    if (part.empty()) continue;
    add_to((*cell.children)[static_cast<std::size_t>(child)], corner_of(child, corner, 0.5 * size_m), 0.5 * size_m,
           level + 1, part);
  }
}

const Plane* PlaneMap::find(const VoxelKey& key, const Eigen::Vector3d& point) const {
  const Root* root = roots_.find(key);
  if (root == nullptr || path_m_ - root->seen_at_m > options_.forget_after_m) return nullptr;
  const Cell* cell = &root->cell;
  Eigen::Vector3d corner = corner_of(key, options_.voxel_m);
  for (double half_m = 0.5 * options_.voxel_m; !cell->is_plane && cell->children != nullptr; half_m *= 0.5) {
    const int child = child_of(point, corner, half_m);
    cell = &(*cell->children)[static_cast<std::size_t>(child)];
    corner = corner_of(child, corner, half_m);
  }
  return cell->is_plane ? &cell->plane : nullptr;
}

const Plane* PlaneMap::find(const Eigen::Vector3d& point) const { return find(key_of(point), point); }

const Plane* PlaneMap::find_beside(const Eigen::Vector3d& point) const {
  VoxelKey key = key_of(point);
  const Eigen::Vector3d from_middle =
      point / options_.voxel_m - Eigen::Vector3d(key.x, key.y, key.z) - Eigen::Vector3d::Constant(0.5);
  int axis = 0;
  from_middle.cwiseAbs().maxCoeff(&axis);
  std::int32_t& index = axis == 0 ? key.x : axis == 1 ? key.y : key.z;
  index += from_middle[axis] < 0.0 ? -1 : 1;
  return find(key, point);
}

}  // namespace cmap
