#include <array>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/metrics/point_spacing.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {
namespace {

/// One point of each place, as a cloud of its own: a point that shares its place finds the first one there.
PointCloud places_of(const Bvh& map) {
  const NearestField nearest = find_nearest(map, map.points);
  PointCloud places;
  places.origin = map.points.origin;
  for (std::size_t slot = 0; slot < map.points.size; ++slot) {
    if (nearest.slot[slot] == slot) places.positions.push_back(map.points.offset(slot));
  }
  return places;
}

/// Of a map without copies.
PointSpacing spacing_of_places(const Bvh& map) {
  const PointBlocks& points = map.points;
  PointSpacing spacing{std::nan(""), std::nan(""), points.size, 0};
  if (points.size < 2) return spacing;
  const Array<std::uint32_t> nearest = find_k_nearest(map, points, 2);  // itself and the next one
  Array<double> distances_m(points.size);
  const auto total_m = ordered_sum<ExactSum>(points.size, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Eigen::Vector3f to = points.offset(nearest[2 * slot + 1]), from = points.offset(slot);
      distances_m[slot] = (to.cast<double>() - from.cast<double>()).norm();
    }
    ExactSum part;
    part.add(std::span(distances_m).subspan(begin, end - begin));
    return part;
  });
  spacing.median_m = quantiles(distances_m, std::array{0.5}).front();
  spacing.mean_m = total_m.value() / static_cast<double>(points.size);
  return spacing;
}

}  // namespace

PointSpacing point_spacing(const Bvh& map) {
  const PointCloud places = places_of(map);
  if (places.size() == map.points.size) return spacing_of_places(map);
  PointSpacing spacing = spacing_of_places(Bvh(sort_points(places)));
  spacing.n_copies = map.points.size - places.size();
  return spacing;
}

}  // namespace cmap
