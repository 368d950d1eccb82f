#include "cmap/metrics/color_consistency.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include "cmap/metrics/order_statistics.hpp"
#include "metrics/voxels.hpp"

namespace cmap {
namespace {

/// Sums of a voxel's colors in 1/255 units: exact for 8-bit colors.
struct ColorSums {
  std::uint64_t n = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double sum_sq = 0.0;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  ///< of the first point
  bool one_place = true;

  void add(const Eigen::Vector3d& color, const Eigen::Vector3f& offset) {
    if (n == 0) place = offset;
    one_place = one_place && offset == place;
    ++n;
    sum += color;
    sum_sq += color.squaredNorm();
  }

  /// Trace of the covariance in unit RGB squared; 0 of one point.
  double covariance_trace() const {
    if (n < 2) return 0.0;
    const auto count = static_cast<double>(n);
    return std::max(0.0, (sum_sq - sum.squaredNorm() / count) / (count - 1.0)) / (255.0 * 255.0);
  }
};

struct OccupiedVoxel {
  VoxelColorSpread spread;
  std::uint64_t n;
  bool one_place;
};

std::vector<OccupiedVoxel> occupied_voxels(const IndexedMap& map, double voxel_m) {
  if (!map.has_color()) throw std::invalid_argument("color_consistency: the map needs colors");
  const VoxelFrame frame(map.index.bounds(), voxel_m);
  const auto add = [&](ColorSums& sums, std::size_t slot, const Eigen::Vector3d&, const VoxelKey&) {
    if (map.has_color_at(slot)) sums.add(map.color(slot), map.index.points.offset(slot));
  };
  const auto finish = [&](const VoxelKey& key, const ColorSums& sums) -> std::optional<OccupiedVoxel> {
    if (sums.n == 0) return std::nullopt;
    return OccupiedVoxel{{frame.index(key), sums.covariance_trace()}, sums.n, sums.one_place};
  };
  return collect_voxels<ColorSums>(map.index.points, frame, add, finish);
}

}  // namespace

std::vector<VoxelColorSpread> voxel_color_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points,
                                                  Singletons singletons) {
  std::vector<VoxelColorSpread> spreads;
  for (const OccupiedVoxel& voxel : occupied_voxels(map, voxel_m)) {
    if (singletons != Singletons::kExclude || voxel.n >= min_points) spreads.push_back(voxel.spread);
  }
  return spreads;
}

ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points) {
  ColorConsistency consistency;
  std::vector<double> traces;
  double sum = 0.0, sum_of_enough = 0.0;
  for (const OccupiedVoxel& voxel : occupied_voxels(map, voxel_m)) {
    ++consistency.n_occupied;
    sum += voxel.spread.trace;
    if (voxel.n == 1) {
      ++consistency.n_singletons;
      continue;
    }
    traces.push_back(voxel.spread.trace);
    if (voxel.one_place) ++consistency.n_one_place;
    if (voxel.n < min_points) continue;
    ++consistency.n_enough;
    sum_of_enough += voxel.spread.trace;
  }
  consistency.zero = sum / static_cast<double>(consistency.n_occupied);
  consistency.exclude = sum_of_enough / static_cast<double>(consistency.n_enough);
  consistency.median = quantiles(traces, std::array{0.5}).front();
  return consistency;
}

}  // namespace cmap
