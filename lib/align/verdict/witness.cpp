#include "verdict/witness.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPlanePoints = 10;
constexpr std::size_t kMostWitnesses = 3000;
constexpr double kThin = 0.2;  ///< variance across a surface over that along, at most
constexpr double kFacesUp = 0.9, kFacesAside = 0.35;
constexpr double kNearGround = 2.0;  ///< voxels of the plan's layers
constexpr double kFullBlock = 3.0;   ///< points from which a block counts as one

double spacing_of(const Bvh& index) {
  constexpr std::size_t kSample = 1000;
  return median_spacing_m(index, every_few(index.points.size, kSample));
}

}  // namespace

FineMap::FineMap(const PointCloud& cloud, double voxel_m)
    : points(thinned_to(cloud, voxel_m), kPlanePoints), spacing_m(spacing_of(points.index)) {}

bool FineMap::is_surface(std::size_t slot) const {
  return points.surface.normal(slot).squaredNorm() > 0.5 &&
         points.surface.tilt_variance(slot) * static_cast<double>(kPlanePoints) < kThin;
}

WitnessMap::WitnessMap(FineMap& fine, const ColumnMap& plan, double block_m) : fine_(fine), plan_(plan) {
  const Array<std::uint32_t> slots = every_few(fine.points.index.points.size, kMostWitnesses);
  fine.points.surface.fit(slots);
  points_ = chosen_points(fine.points.index.points, slots);
  for (const std::uint32_t slot : slots) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (fine.is_surface(slot)) normal = fine.points.surface.normal(slot).cast<float>();
    witnesses_.push_back({normal, 1.0f, kind_of(fine.points.index.points.offset(slot).cast<double>(), normal)});
  }
  weigh(block_m);
}

std::uint8_t WitnessMap::kind_of(const Eigen::Vector3d& p, const Eigen::Vector3f& normal) const {
  const double lift = std::abs(normal.cast<double>().dot(plan_.upright.row(2).transpose()));
  const int facing = normal.squaredNorm() < 0.5f ? 3 : lift > kFacesUp ? 0 : lift < kFacesAside ? 1 : 2;
  const Eigen::Vector3d turned = plan_.upright * p;
  const Eigen::Vector2d cell = plan_.cell_at(turned.head<2>());
  const int x = std::clamp(static_cast<int>(cell.x()), 0, plan_.width - 1);
  const int y = std::clamp(static_cast<int>(cell.y()), 0, plan_.height - 1);
  const bool is_high = turned.z() - static_cast<double>(plan_.ground_at(x, y)) > kNearGround * plan_.layer_m;
  return static_cast<std::uint8_t>(facing + (is_high ? 4 : 0));
}

void WitnessMap::weigh(double block_m) {
  std::array<VoxelMap<double>, kClasses> counts;
  PointCloud box_of;
  for (std::size_t slot = 0; slot < size(); ++slot) box_of.positions.push_back(points_.offset(slot));
  const VoxelFrame frame(bounds(box_of), block_m);
  const auto key = [&](std::size_t slot) { return frame.key(points_.offset(slot).cast<double>()); };
  for (std::size_t slot = 0; slot < size(); ++slot) counts[witnesses_[slot].kind][key(slot)] += 1.0;
  for (std::size_t slot = 0; slot < size(); ++slot) {
    const double n = *counts[witnesses_[slot].kind].find(key(slot));
    witnesses_[slot].weight = static_cast<float>(std::min(1.0, n / kFullBlock) / n);
  }
}

bool WitnessMap::was_seen_at(const Eigen::Vector3d& p) const {
  const Eigen::Vector2d cell = plan_.cell_at((plan_.upright * p).head<2>());
  const int x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
  return plan_.word_at(x, y) != ColumnMap::kEmpty;
}

}  // namespace cmap
