#include "cmap/geometry/voxel_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/geometry/color.hpp"

namespace cmap {

VoxelFrame::VoxelFrame(const Box3d& box, double size_m) : size_m_(size_m) {
  if (!(size_m > 0.0)) throw std::invalid_argument("the voxel size must be positive");
  constexpr double kMostVoxels = std::numeric_limits<std::int32_t>::max() - 2;
  constexpr double kLargestIndex = 0x1p52;
  for (int axis = 0; axis < 3; ++axis) {
    const double largest = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    if ((box.max[axis] - box.min[axis]) / size_m > kMostVoxels || largest / size_m > kLargestIndex) {
      throw UsageError(fmt::format("voxels of {} m are too small for a map of {:.6g} m at {:.6g} m", size_m,
                                   box.max[axis] - box.min[axis], largest));
    }
    base_[axis] = static_cast<std::int64_t>(std::floor(box.min[axis] / size_m));
  }
}

namespace {

struct Mean {
  std::uint32_t n = 0, n_colored = 0;
  Eigen::Vector3d position_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d color_sum = Eigen::Vector3d::Zero();
};

}  // namespace

PointCloud voxel_thinned(const PointCloud& cloud, double voxel_m) {
  VoxelMap<Mean> means;
  const VoxelFrame frame(bounds(cloud), voxel_m);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Mean& mean = means[frame.key(cloud.world(i))];
    ++mean.n;
    mean.position_sum += cloud.positions[i].cast<double>();
    if (cloud.has_color()) {
      const RgbF color = rgb_255(cloud.colors, i);
      if (std::isnan(color[0])) continue;
      mean.color_sum += Eigen::Vector3d(color[0], color[1], color[2]);
      ++mean.n_colored;
    }
  }

  PointCloud thinned;
  thinned.origin = cloud.origin;
  thinned.positions.reserve(means.entries().size());
  Array<RgbF> colors;
  for (const auto& [key, mean] : means.entries()) {
    thinned.positions.push_back((mean.position_sum / mean.n).cast<float>());
    const Eigen::Vector3f color = (mean.color_sum / (255.0 * mean.n_colored)).cast<float>();
    if (cloud.has_color()) colors.push_back({color.x(), color.y(), color.z()});
  }
  if (cloud.has_color()) thinned.colors = std::move(colors);
  return thinned;
}

}  // namespace cmap
