#include "loops/submaps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cmap/core/sampled_indices.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

bool has_points(const Submap& submap, std::span<const Keyframe> keyframes) {
  const auto part = keyframes.subspan(submap.first, submap.last - submap.first + 1);
  return std::any_of(part.begin(), part.end(), [](const Keyframe& k) { return !k.points_body.empty(); });
}

}  // namespace

std::vector<double> path_lengths_m(std::span<const Keyframe> keyframes) {
  std::vector<double> paths_m(keyframes.size(), 0.0);
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const Eigen::Vector3d step = keyframes[i].T_world_body.translation() - keyframes[i - 1].T_world_body.translation();
    paths_m[i] = paths_m[i - 1] + step.norm();
  }
  return paths_m;
}

std::vector<Submap> submaps_of(std::span<const Keyframe> keyframes, std::span<const double> paths_m,
                               const LoopOptions& options) {
  std::vector<Submap> submaps;
  double next_m = 0.0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (paths_m[i] < next_m) continue;
    next_m = paths_m[i] + options.submap_spacing_m;
    const auto first = std::lower_bound(paths_m.begin(), paths_m.end(), paths_m[i] - 0.5 * options.submap_m);
    const auto end = std::upper_bound(paths_m.begin(), paths_m.end(), paths_m[i] + 0.5 * options.submap_m);
    const Submap submap{i, static_cast<std::size_t>(first - paths_m.begin()),
                        static_cast<std::size_t>(end - paths_m.begin()) - 1, paths_m[i]};
    if (has_points(submap, keyframes)) submaps.push_back(submap);
  }
  return submaps;
}

Eigen::Isometry3d level_frame(const Eigen::Isometry3d& T_world_body) {
  const Eigen::Matrix3d& R = T_world_body.linear();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(std::atan2(R(1, 0), R(0, 0)), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = T_world_body.translation();
  return T;
}

PointCloud points_of(const Submap& submap, std::span<const Keyframe> keyframes, double voxel_m) {
  const Eigen::Isometry3d T_level_world = level_frame(keyframes[submap.center].T_world_body).inverse();
  PointCloud cloud;
  for (const std::size_t i : sampled_indices(submap.last - submap.first + 1, kMostKeyframes)) {
    const Keyframe& keyframe = keyframes[submap.first + i];
    const Eigen::Isometry3f T = (T_level_world * keyframe.T_world_body).cast<float>();
    for (const Eigen::Vector3f& p : keyframe.points_body) cloud.positions.push_back(T * p);
  }
  return cloud.positions.empty() ? cloud : voxel_thinned(cloud, voxel_m);
}

double ground_height_m(const PointCloud& points) {
  if (points.positions.empty()) throw std::invalid_argument("a submap without points has no ground");
  std::vector<float> heights(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) heights[i] = points.positions[i].z();
  return static_cast<double>(value_at_rank(heights, heights.size() / 20));
}

}  // namespace cmap
