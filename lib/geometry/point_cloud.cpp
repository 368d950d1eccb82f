#include "cmap/geometry/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cmap/geometry/core_box.hpp"
#include "cmap/geometry/point_extent.hpp"

namespace cmap {
namespace {

template <class T>
Array<T> select_values(const Array<T>& values, const Array<std::uint8_t>& keep, std::size_t n_kept) {
  Array<T> kept(n_kept);
  std::size_t out = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i]) kept[out++] = values[i];
  }
  return kept;
}

}  // namespace

std::string_view color_type_name(const Colors& colors) {
  constexpr std::array<std::string_view, 4> kNames{"none", "u8", "u16", "f32"};
  return kNames[colors.index()];
}

Box3d bounds(const PointCloud& cloud) {
  if (cloud.positions.empty()) throw std::invalid_argument("bounds of an empty point cloud");
  const PointExtent<float> extent = point_extent(cloud.positions.front().data(), cloud.size());
  const Eigen::Vector3f low(extent.min.data()), high(extent.max.data());
  return {cloud.origin + low.cast<double>(), cloud.origin + high.cast<double>()};
}

Eigen::Vector3d choose_origin(const Box3d& box) {
  Eigen::Vector3d origin;
  for (int axis = 0; axis < 3; ++axis) {
    double unit_m = 100.0;
    while (unit_m < box.max[axis] - box.min[axis]) unit_m *= 10.0;
    // Not std::round, whose halves go away from zero: a shifted box must round the same way. + 0.0: never -0.
    origin[axis] = std::floor(0.5 * (box.min[axis] + box.max[axis]) / unit_m + 0.5) * unit_m + 0.0;
  }
  return origin;
}

PointCloud select(const PointCloud& cloud, const Array<std::uint8_t>& keep) {
  if (keep.size() != cloud.size()) throw std::invalid_argument("select: one flag per point is needed");
  const auto n_kept = static_cast<std::size_t>(std::count_if(keep.begin(), keep.end(), [](auto k) { return k != 0; }));
  PointCloud kept;
  kept.origin = cloud.origin;
  kept.file_step_m = cloud.file_step_m;
  kept.positions = select_values(cloud.positions, keep, n_kept);
  std::visit(
      [&]<class T>(const T& colors) {
        if constexpr (!std::is_same_v<T, std::monostate>) kept.colors = select_values(colors, keep, n_kept);
      },
      cloud.colors);
  return kept;
}

PointCloud crop(const PointCloud& cloud, const Box3d& box) {
  Array<std::uint8_t> keep(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d x = cloud.world(i);
    keep[i] = (x.array() >= box.min.array()).all() && (x.array() <= box.max.array()).all();
  }
  return select(cloud, keep);
}

PointCloud sampled(const PointCloud& cloud, std::size_t most) {
  const std::size_t step = cloud.size() / most + 1;
  PointCloud sample;
  sample.origin = cloud.origin;
  for (std::size_t i = 0; i < cloud.size(); i += step) sample.positions.push_back(cloud.positions[i]);
  return sample;
}

PointCloud transformed(const PointCloud& cloud, const Eigen::Matrix4d& T_new_old) {
  PointCloud moved;
  moved.colors = cloud.colors;
  if (cloud.positions.empty()) return moved;
  const Eigen::Matrix3d linear = T_new_old.topLeftCorner<3, 3>();
  moved.file_step_m = cloud.file_step_m * linear.col(0).norm();
  // The old origin is carried over in double, so that only offsets are rounded to float.
  const Eigen::Vector3d new_place = linear * cloud.origin + T_new_old.topRightCorner<3, 1>();
  Box3d box{Eigen::Vector3d::Constant(INFINITY), Eigen::Vector3d::Constant(-INFINITY)};
  const auto new_position = [&](const Eigen::Vector3f& p) {
    return Eigen::Vector3d(linear * p.cast<double>() + new_place);
  };
  for (const Eigen::Vector3f& p : cloud.positions) {
    const Eigen::Vector3d x = new_position(p);
    box.min = box.min.cwiseMin(x);
    box.max = box.max.cwiseMax(x);
  }
  const auto at = [&](std::size_t i) { return new_position(cloud.positions[i]); };
  moved.origin = choose_origin(box, cloud_core(cloud.size(), at));
  const Eigen::Vector3d shift = new_place - moved.origin;
  moved.positions.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    moved.positions[i] = (linear * cloud.positions[i].cast<double>() + shift).cast<float>();
  }
  return moved;
}

}  // namespace cmap
