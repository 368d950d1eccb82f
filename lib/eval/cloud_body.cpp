#include "cloud_body.hpp"

#include "cmap/geometry/core_box.hpp"

namespace cmap {

CloudBody body_of(const PointCloud& cloud) {
  const Box3d all = bounds(cloud);
  const CloudCore core = cloud_core(cloud.size(), [&](std::size_t i) { return cloud.world(i); });
  CloudBody body{cloud.size(), all, core.box, all};
  if (!core.is_stretched(all)) return body;
  body.box = body.core;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d x = cloud.world(i);
    const double distance_m = distance_to(body.core, x);
    if (distance_m <= core.reach_m) {
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
