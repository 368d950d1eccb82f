#include "cmap/colorize/surfels.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "cmap/spatial/point_blocks.hpp"

namespace cmap {
namespace {

constexpr std::size_t kBatch = std::size_t{1} << 19;  ///< queries at once: their neighbors take 32 MiB
constexpr std::size_t kFitChunk = 2048;
constexpr std::size_t kNearest = 4;  ///< whose distance is the radius

Array<std::uint32_t> slots_from(std::size_t begin, std::size_t end) {
  Array<std::uint32_t> slots(end - begin);
  for (std::size_t i = 0; i < slots.size(); ++i) slots[i] = static_cast<std::uint32_t>(begin + i);
  return slots;
}

/// Plane and spacing around a slot; its neighbors begin with itself, or a point in the same place.
void fit_disc(const PointBlocks& points, std::span<const std::uint32_t> neighbors, const SurfelOptions& options,
              std::size_t slot, Surfels& surfels) {
  const Eigen::Vector3f here = points.offset(slot);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double n = 0.0, distances = 0.0, n_distances = 0.0;
  for (const std::uint32_t other : neighbors) {
    if (other == kNoNeighbor) break;
    const Eigen::Vector3d d = (points.offset(other) - here).cast<double>();
    sum += d;
    squares += d * d.transpose();
    n += 1.0;
    if (n > 1.0 && n_distances < kNearest) {
      distances += d.norm();
      n_distances += 1.0;
    }
  }
  const double spacing = n_distances > 0.0 ? distances / n_distances : options.least_radius_m;
  surfels.radius_m[slot] = static_cast<float>(std::clamp(spacing, options.least_radius_m, options.largest_radius_m));
  surfels.normals[slot] = Eigen::Vector3f::Zero();
  if (n < 4.0) return;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(squares - sum * sum.transpose() / n);
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  if (normal.allFinite()) surfels.normals[slot] = normal.cast<float>();
}

SurfelGroup group_of(const Surfels& surfels, std::size_t begin, std::size_t end) {
  Eigen::Vector3f low = surfels.positions[begin], high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(surfels.positions[i]);
    high = high.cwiseMax(surfels.positions[i]);
  }
  SurfelGroup group{0.5f * (low + high), 0.0f};
  for (std::size_t i = begin; i < end; ++i) {
    group.radius_m = std::max(group.radius_m, (surfels.positions[i] - group.center).norm() + surfels.radius_m[i]);
  }
  return group;
}

}  // namespace

Surfels surfels_of(const PointCloud& cloud, const SurfelOptions& options) {
  const Bvh index(sort_points(cloud));
  const PointBlocks& points = index.points;
  Surfels surfels;
  surfels.origin = points.origin;
  surfels.positions.resize(points.size);
  surfels.normals.resize(points.size);
  surfels.radius_m.resize(points.size);
  surfels.original_index.assign(points.original_index.begin(),
                                points.original_index.begin() + static_cast<std::ptrdiff_t>(points.size));
  const auto k = static_cast<std::size_t>(options.neighbors) + 1;
  for (std::size_t first = 0; first < points.size; first += kBatch) {
    const std::size_t last = std::min(points.size, first + kBatch);
    const Array<std::uint32_t> neighbors = find_k_nearest(index, chosen_points(points, slots_from(first, last)), k);
    parallel_chunks(last - first, kFitChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        surfels.positions[first + i] = points.offset(first + i);
        fit_disc(points, {neighbors.data() + i * k, k}, options, first + i, surfels);
      }
    });
  }
  for (std::size_t begin = 0; begin < surfels.size(); begin += Surfels::kGroup) {
    surfels.groups.push_back(group_of(surfels, begin, std::min(surfels.size(), begin + Surfels::kGroup)));
  }
  return surfels;
}

double spacing_of(const PointCloud& cloud) {
  if (cloud.size() < 2) return 0.0;
  const Bvh index(sort_points(cloud));
  const std::size_t step = (cloud.size() + 9'999) / 10'000;
  Array<std::uint32_t> slots;
  for (std::size_t slot = 0; slot < cloud.size(); slot += step) slots.push_back(static_cast<std::uint32_t>(slot));
  const Array<std::uint32_t> neighbors = find_k_nearest(index, chosen_points(index.points, slots), 2);
  std::vector<double> distances;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    distances.push_back(
        static_cast<double>((index.points.offset(neighbors[2 * i + 1]) - index.points.offset(slots[i])).norm()));
  }
  return upper_median(distances);
}

}  // namespace cmap
