#include "witness.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/k_nearest.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPlanePoints = 10;
constexpr double kThin = 0.2;        ///< variance across a surface over that along, at most
constexpr double kFacesUp = 0.9, kFacesAside = 0.35;
constexpr double kNearGround = 2.0;  ///< voxels of the plan's layers
constexpr double kFullBlock = 3.0;   ///< points from which a block counts as one

double spacing_of(const Bvh& index) {
  constexpr std::size_t kSample = 1000;
  Array<std::uint32_t> slots;
  for (std::size_t slot = 0; slot < index.points.size; slot += index.points.size / kSample + 1) {
    slots.push_back(static_cast<std::uint32_t>(slot));
  }
  const Array<std::uint32_t> nearest = find_k_nearest(index, chosen_points(index.points, slots), 2);
  Array<double> spacing(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t other = nearest[2 * i + 1];
    spacing[i] = other == kNoNeighbor ? 0.0 : (index.points.offset(slots[i]) - index.points.offset(other)).norm();
  }
  return upper_median(spacing);
}

}  // namespace

bool is_surface(const Surface& surface, std::size_t slot) {
  return surface.normal(slot).squaredNorm() > 0.5 &&
         surface.tilt_variance(slot) * static_cast<double>(kPlanePoints) < kThin;
}

WitnessMap::WitnessMap(const PointCloud& cloud, const ColumnMap& plan, const Sizes& sizes)
    : columns(plan),
      fine(thinned_to(cloud, sizes.fine_voxel_m), kPlanePoints),
      spacing_m(spacing_of(fine.index)),
      points(choose(sizes)) {
  weigh(sizes.block_m);
}

PointCloud WitnessMap::choose(const Sizes& sizes) {
  const PointBlocks& all = fine.index.points;
  const std::size_t step = (all.size + sizes.most_points - 1) / sizes.most_points;
  Array<std::uint32_t> slots;
  for (std::size_t slot = step / 2; slot < all.size; slot += step) slots.push_back(static_cast<std::uint32_t>(slot));
  fine.surface.fit(slots);
  PointCloud chosen;
  chosen.origin = all.origin;
  for (const std::uint32_t slot : slots) {
    chosen.positions.push_back(all.offset(slot));
    const Eigen::Vector3d normal = is_surface(fine.surface, slot) ? fine.surface.normal(slot) : Eigen::Vector3d::Zero();
    witnesses.push_back({normal.cast<float>(), 1.0f, 0});
  }
  return chosen;
}

void WitnessMap::weigh(double block_m) {
  const std::vector<Witness> chosen = witnesses;
  const PointBlocks& moved = points.points();
  std::array<VoxelMap<double>, kClasses> counts;
  const VoxelFrame frame(bounds(PointCloud{Eigen::Vector3d::Zero(),
                                           [&] {
                                             Array<Eigen::Vector3f> offsets;
                                             for (std::size_t s = 0; s < moved.size; ++s) {
                                               offsets.push_back(moved.offset(s));
                                             }
                                             return offsets;
                                           }(),
                                           {},
                                           0.0}),
                         block_m);
  const Eigen::Vector3d up = columns.upright.row(2).transpose();
  for (std::size_t slot = 0; slot < moved.size; ++slot) {
    Witness& witness = witnesses[slot];
    witness = chosen[moved.original_index[slot]];
    const Eigen::Vector3d p = moved.offset(slot).cast<double>();
    const double lift = std::abs(witness.normal.cast<double>().dot(up));
    const bool has_surface = witness.normal.squaredNorm() > 0.5f;
    const int facing = !has_surface ? 3 : lift > kFacesUp ? 0 : lift < kFacesAside ? 1 : 2;
    const Eigen::Vector3d turned = columns.upright * p;
    const Eigen::Vector2d cell = (turned.head<2>() - columns.low_m) / columns.cell_m;
    const int x = std::clamp(static_cast<int>(cell.x()), 0, columns.width - 1);
    const int y = std::clamp(static_cast<int>(cell.y()), 0, columns.height - 1);
    const bool is_high = turned.z() - static_cast<double>(columns.ground_at(x, y)) > kNearGround * columns.layer_m;
    witness.kind = static_cast<std::uint8_t>(facing + (is_high ? 4 : 0));
    counts[witness.kind][frame.key(p)] += 1.0;
  }
  for (std::size_t slot = 0; slot < moved.size; ++slot) {
    const double n = *counts[witnesses[slot].kind].find(frame.key(moved.offset(slot).cast<double>()));
    witnesses[slot].weight = static_cast<float>(std::min(1.0, n / kFullBlock) / n);
  }
}

bool WitnessMap::was_seen_at(const Eigen::Vector3d& p) const {
  const Eigen::Vector2d cell = ((columns.upright * p).head<2>() - columns.low_m) / columns.cell_m;
  const int x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
  return columns.word_at(x, y) != ColumnMap::kEmpty;
}

}  // namespace cmap
