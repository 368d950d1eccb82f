#include "cmap/geometry/core_box.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "cmap/geometry/order_statistics.hpp"

namespace cmap {

Box3d core_box(const std::vector<Eigen::Vector3d>& sample) {
  if (sample.size() < kFewestForCore) throw std::invalid_argument("core_box: too few points");
  const std::size_t cut = std::max<std::size_t>(1, sample.size() / 100);
  std::vector<double> values(sample.size());
  Box3d core;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(sample, values.begin(), [&](const Eigen::Vector3d& p) { return p[axis]; });
    core.min[axis] = value_at_rank(values, cut);
    core.max[axis] = value_at_rank(values, values.size() - 1 - cut);
  }
  return core;
}

double stray_reach_m(const Box3d& core) {
  const double diagonal_m = (core.max - core.min).norm();
  return diagonal_m > 0.0 ? kStrayDiagonals * diagonal_m : std::numeric_limits<double>::infinity();
}

CloudCore cloud_core(const std::vector<Eigen::Vector3d>& sample) {
  if (sample.empty()) throw std::invalid_argument("cloud_core: no points");
  if (sample.size() >= kFewestForCore) {
    const Box3d core = core_box(sample);
    return {core, stray_reach_m(core)};
  }
  Box3d all{sample.front(), sample.front()};
  for (const Eigen::Vector3d& x : sample) all = {all.min.cwiseMin(x), all.max.cwiseMax(x)};
  return {all, std::numeric_limits<double>::infinity()};
}

Eigen::Vector3d choose_origin(const Box3d& box, const CloudCore& core) {
  return choose_origin(core.is_stretched(box) ? core.box : box);
}

}  // namespace cmap
