#include "cmap/metrics/color_consistency.hpp"

#include <array>
#include <limits>
#include <numeric>
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

  /// Trace of the covariance in unit RGB squared.
  double covariance_trace() const {
    const auto count = static_cast<double>(n);
    return std::max(0.0, (sum_sq - sum.squaredNorm() / count) / (count - 1.0)) / (255.0 * 255.0);
  }
};

/// result_of(index, trace) for every voxel with at least min_points points.
template <class ResultOf>
auto collect_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points, ResultOf&& result_of) {
  if (!map.has_color()) throw std::invalid_argument("color_consistency: the map needs colors");
  const VoxelFrame frame(map.index.bounds(), voxel_m);
  const auto add = [&](ColorSums& sums, std::size_t slot, const Eigen::Vector3d&, const VoxelKey&) {
    const Eigen::Vector3d color = map.color(slot);
    ++sums.n;
    sums.sum += color;
    sums.sum_sq += color.squaredNorm();
  };
  using Result = std::invoke_result_t<ResultOf, const std::array<std::int64_t, 3>&, double>;
  return collect_voxels<ColorSums>(map.index.points, frame, add,
                                   [&](const VoxelKey& key, const ColorSums& sums) -> std::optional<Result> {
                                     if (sums.n < min_points) return std::nullopt;
                                     return result_of(frame.index(key), sums.covariance_trace());
                                   });
}

}  // namespace

std::vector<VoxelColorSpread> voxel_color_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points) {
  return collect_spreads(map, voxel_m, min_points,
                         [](const auto& index, double trace) {
                           return VoxelColorSpread{index, trace};
                         })
      .results;
}

ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points) {
  const auto voxels = collect_spreads(map, voxel_m, min_points, [](const auto&, double trace) { return trace; });
  const std::vector<double>& traces = voxels.results;
  ColorConsistency consistency;
  consistency.n_voxels = traces.size();
  consistency.n_voxels_below_min = voxels.n_without_result;
  consistency.mean = std::accumulate(traces.begin(), traces.end(), 0.0) / static_cast<double>(traces.size());
  consistency.median = quantiles(traces, std::array{0.5}).front();
  return consistency;
}

}  // namespace cmap
