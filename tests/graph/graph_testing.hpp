#pragma once

#include "align/align_testing.hpp"
#include "cmap/graph/pose_graph.hpp"

namespace cmap::test {

inline Eigen::Isometry3d pose_of(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = R;
  pose.translation() = t;
  return pose;
}

inline Eigen::Isometry3d random_pose(std::mt19937_64& random, double reach_m) {
  const Eigen::Matrix3d R = random_rotation(random);
  return pose_of(R, random_vector(random, reach_m));
}

/// The pose with a small motion in front of it: of its own axes for the rotation, of the world's for the position.
inline Eigen::Isometry3d nudged(const Eigen::Isometry3d& pose, const Eigen::Vector3d& shift,
                                const Eigen::Vector3d& turn) {
  return pose_of(pose.linear() * rotation_from(turn), pose.translation() + shift);
}

inline Eigen::Isometry3d nudged(const Eigen::Isometry3d& pose, std::mt19937_64& random, double size) {
  const Eigen::Vector3d shift = random_vector(random, size);
  return nudged(pose, shift, random_vector(random, size));
}

template <int kDim>
Eigen::Matrix<double, kDim, kDim> random_information(std::mt19937_64& random) {
  Eigen::Matrix<double, kDim, kDim> root;
  for (double& value : root.reshaped()) value = uniform_in(random, -1.0, 1.0);
  return root * root.transpose() + 0.5 * Eigen::Matrix<double, kDim, kDim>::Identity();
}

/// n nodes on a random path with edges to the next and the third next node that agree exactly.
inline PoseGraph exact_graph(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  PoseGraph graph;
  for (std::size_t i = 0; i < n; ++i) graph.poses.push_back(random_pose(random, 10.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}}) {
      const std::size_t j = i + step;
      if (j >= n) continue;
      graph.edges.push_back({i, j, graph.poses[i].inverse() * graph.poses[j], random_information<6>(random), 0.0});
    }
  }
  return graph;
}

/// A pose without its scale.
inline Eigen::Isometry3d rigid_part(const Similarity& pose) { return pose_of(pose.rotation, pose.translation); }

inline Similarity with_scale(double scale, const Eigen::Isometry3d& pose) {
  return {scale, pose.linear(), pose.translation()};
}

inline Similarity relative(const Similarity& a, const Similarity& b) {
  const Eigen::Isometry3d step = rigid_part(a).inverse() * rigid_part(b);
  return {b.scale / a.scale, step.linear(), step.translation() / a.scale};
}

/// The same with a scale of its own for every node, from 1/3 to 3; node 0 has scale 1.
inline ScaledPoseGraph exact_scaled_graph(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  ScaledPoseGraph graph;
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = i == 0 ? 1.0 : std::pow(3.0, uniform_in(random, -1.0, 1.0));
    graph.poses.push_back(with_scale(scale, random_pose(random, 10.0)));
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}}) {
      const std::size_t j = i + step;
      if (j >= n) continue;
      graph.edges.push_back({i, j, relative(graph.poses[i], graph.poses[j]), random_information<7>(random), 0.0});
    }
  }
  return graph;
}

}  // namespace cmap::test
