#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "cmap/geometry/order_statistics.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "color_moments.hpp"
#include "voxels.hpp"

namespace cmap {
namespace {

/// Adds a point's color, if it has one, to its voxel.
auto color_adder(const IndexedMap& map) {
  return [&map](ColorMoments& colors, std::size_t slot) {
    if (map.has_color_at(slot)) colors.add(color_at(map.colors, slot), map.index.points.offset(slot));
  };
}

VoxelFrame color_frame(const IndexedMap& map, double voxel_m) {
  if (!map.has_color()) throw std::invalid_argument("color_consistency: the map needs colors");
  return VoxelFrame(map.index.bounds(), voxel_m);
}

/// What the voxels of a part of the map add up to.
struct PartOfMap {
  std::uint64_t n_occupied = 0, n_enough = 0, n_singletons = 0, n_one_place = 0;
  ExactSum trace, trace_of_enough, sq_trace_of_enough;
  std::vector<double> traces;  ///< of voxels of at least 2 points

  void add(const ColorMoments& voxel, std::uint64_t min_points) {
    if (voxel.n() == 0) return;  // of points without color
    ++n_occupied;
    n_singletons += voxel.n() == 1 ? 1 : 0;
    if (voxel.n() == 1) return;
    traces.push_back(voxel.covariance_trace());
    trace.add(traces.back());
    n_one_place += voxel.one_place() ? 1 : 0;
    if (voxel.n() < min_points) return;
    ++n_enough;
    trace_of_enough.add(traces.back());
    sq_trace_of_enough.add(traces.back() * traces.back());
  }
};

}  // namespace

std::vector<VoxelColors> voxel_colors(const IndexedMap& map, double voxel_m) {
  const VoxelFrame frame = color_frame(map, voxel_m);
  const auto finish = [&](const VoxelKey& key, const ColorMoments& sums) -> std::optional<VoxelColors> {
    if (sums.n() == 0) return std::nullopt;
    return VoxelColors{frame.index(key), sums.n(), sums.one_place(), sums.covariance_trace()};
  };
  return collect_voxels<ColorMoments>(map.index, frame, color_adder(map), finish);
}

ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points) {
  const auto use = [&](PartOfMap& part, const VoxelKey&, const ColorMoments& sums) { part.add(sums, min_points); };
  ColorConsistency all;
  std::vector<double> traces;
  for (const PartOfMap& part :
       fold_voxels<PartOfMap, ColorMoments>(map.index, color_frame(map, voxel_m), color_adder(map), use)) {
    all.n_occupied.add(static_cast<double>(part.n_occupied));
    all.n_enough.add(static_cast<double>(part.n_enough));
    all.n_singletons.add(static_cast<double>(part.n_singletons));
    all.n_one_place.add(static_cast<double>(part.n_one_place));
    all.trace += part.trace;
    all.trace_of_enough += part.trace_of_enough;
    all.sq_trace_of_enough += part.sq_trace_of_enough;
    traces.insert(traces.end(), part.traces.begin(), part.traces.end());
  }
  all.median = quantiles(traces, std::array{0.5}).front();
  return all;
}

}  // namespace cmap
