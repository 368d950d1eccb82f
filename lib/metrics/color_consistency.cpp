#include "cmap/metrics/color_consistency.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "cmap/metrics/order_statistics.hpp"
#include "metrics/voxels.hpp"

namespace cmap {
namespace {

/// Sums of a voxel's colors in 1/255 units: exact for 8-bit colors.
struct ColorSums {
  std::uint32_t n = 0;
  bool one_place = true;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  ///< of the first point
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double sum_sq = 0.0;

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

/// Adds a point's color, if it has one, to its voxel.
auto color_adder(const IndexedMap& map) {
  return [&map](ColorSums& sums, std::size_t slot, const Eigen::Vector3d&, const VoxelKey&) {
    if (map.has_color_at(slot)) sums.add(map.color(slot), map.index.points.offset(slot));
  };
}

VoxelFrame frame_of(const IndexedMap& map, double voxel_m) {
  if (!map.has_color()) throw std::invalid_argument("color_consistency: the map needs colors");
  return VoxelFrame(map.index.bounds(), voxel_m);
}

/// What the voxels of a part of the map add up to.
struct PartSums {
  std::uint64_t n_occupied = 0, n_enough = 0, n_one_place = 0;
  double sum = 0.0, sum_of_enough = 0.0;
  std::vector<double> traces;  ///< of voxels of at least 2 points

  void add(const ColorSums& voxel, std::uint64_t min_points) {
    if (voxel.n == 0) return;  // of points without color
    ++n_occupied;
    if (voxel.n == 1) return;
    const double trace = voxel.covariance_trace();
    traces.push_back(trace);
    sum += trace;
    if (voxel.one_place) ++n_one_place;
    if (voxel.n < min_points) return;
    ++n_enough;
    sum_of_enough += trace;
  }
};

}  // namespace

std::vector<VoxelColorSpread> voxel_color_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points,
                                                  Singletons singletons) {
  const VoxelFrame frame = frame_of(map, voxel_m);
  const std::uint64_t fewest = singletons == Singletons::kExclude ? min_points : 1;
  const auto finish = [&](const VoxelKey& key, const ColorSums& sums) -> std::optional<VoxelColorSpread> {
    if (sums.n < fewest) return std::nullopt;
    return VoxelColorSpread{frame.index(key), sums.covariance_trace()};
  };
  return collect_voxels<ColorSums>(map.index.points, frame, color_adder(map), finish);
}

ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points) {
  const auto use = [&](PartSums& part, const VoxelKey&, const ColorSums& sums) { part.add(sums, min_points); };
  ColorConsistency consistency;
  std::vector<double> traces;
  double sum = 0.0, sum_of_enough = 0.0;
  for (const PartSums& part :
       fold_voxels<PartSums, ColorSums>(map.index.points, frame_of(map, voxel_m), color_adder(map), use)) {
    consistency.n_occupied += part.n_occupied;
    consistency.n_enough += part.n_enough;
    consistency.n_one_place += part.n_one_place;
    sum += part.sum;
    sum_of_enough += part.sum_of_enough;
    traces.insert(traces.end(), part.traces.begin(), part.traces.end());
  }
  consistency.n_singletons = consistency.n_occupied - traces.size();
  consistency.zero = sum / static_cast<double>(consistency.n_occupied);
  consistency.exclude = sum_of_enough / static_cast<double>(consistency.n_enough);
  consistency.median = quantiles(traces, std::array{0.5}).front();
  return consistency;
}

}  // namespace cmap
