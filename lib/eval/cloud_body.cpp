#include "eval/cloud_body.hpp"

#include <vector>

#include "cmap/core/core_box.hpp"
#include "cmap/core/sampled_indices.hpp"

namespace cmap {
namespace {

Box3d core_of(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> sample;
  for (const std::size_t i : sampled_indices(cloud.size(), kCoreSample)) sample.push_back(cloud.world(i));
  return core_box(sample);
}

}  // namespace

CloudBody body_of(const PointCloud& cloud) {
  const Box3d all = bounds(cloud);
  if (cloud.size() < kFewestForCore) return {cloud.size(), all, all, all};
  CloudBody body{cloud.size(), all, core_of(cloud), all};
  const double reach_m = stray_reach_m(body.core);
  if (distance_to(body.core, all.min) <= reach_m && distance_to(body.core, all.max) <= reach_m) return body;
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
