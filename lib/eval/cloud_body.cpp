#include "eval/cloud_body.hpp"

#include <algorithm>
#include <vector>

#include "eval/sampled_indices.hpp"

namespace cmap {
namespace {

constexpr std::size_t kSample = 10000;
constexpr std::size_t kFewest = 10;  // below, every point may be an end of the map
constexpr double kStrayDiagonals = 10.0;

/// Box without the outermost hundredth (one point at least) on either side of every axis.
Box3d core_of(const PointCloud& cloud) {
  std::vector<Eigen::Vector3f> sample;
  for (const std::size_t i : sampled_indices(cloud.size(), kSample)) sample.push_back(cloud.positions[i]);
  const std::size_t cut = std::max<std::size_t>(1, sample.size() / 100);
  std::vector<float> values(sample.size());
  Box3d core;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(sample, values.begin(), [&](const Eigen::Vector3f& p) { return p[axis]; });
    const auto low = values.begin() + static_cast<std::ptrdiff_t>(cut);
    const auto high = values.end() - static_cast<std::ptrdiff_t>(cut) - 1;
    std::nth_element(values.begin(), low, values.end());
    core.min[axis] = cloud.origin[axis] + static_cast<double>(*low);
    std::nth_element(values.begin(), high, values.end());
    core.max[axis] = cloud.origin[axis] + static_cast<double>(*high);
  }
  return core;
}

double distance_to(const Box3d& box, const Eigen::Vector3d& x) {
  return (box.min - x).cwiseMax(x - box.max).cwiseMax(0.0).norm();
}

}  // namespace

CloudBody body_of(const PointCloud& cloud) {
  const Box3d all = bounds(cloud);
  if (cloud.size() < kFewest) return {cloud.size(), all, all, all};
  CloudBody body{cloud.size(), all, core_of(cloud), all};
  const double reach_m = kStrayDiagonals * body.core_diagonal_m();
  if (reach_m == 0.0 || (distance_to(body.core, all.min) <= reach_m && distance_to(body.core, all.max) <= reach_m)) {
    return body;
  }
  body.box = body.core;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d x = cloud.world(i);
    const double distance_m = distance_to(body.core, x);
    if (distance_m <= reach_m) {
      body.box = {body.box.min.cwiseMin(x), body.box.max.cwiseMax(x)};
      continue;
    }
    ++body.n_strays;
    if (distance_m > body.farthest_m) {
      body.farthest = i;
      body.farthest_m = distance_m;
    }
  }
  return body;
}

}  // namespace cmap
