#include "loops/loop_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cmap/geometry/rotation.hpp"
#include "loops/loop_consistency.hpp"
#include "loops/submaps.hpp"

namespace cmap {
namespace {

/// Twice around a circle of 50 m, a keyframe every 2 m, by an odometry whose heading drifts.
struct TwoRounds {
  TwoRounds() {
    const double turn_rad = 2.0 / 50.0;
    const auto n = static_cast<std::size_t>(4.0 * std::numbers::pi / turn_rad) + 1;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity(), drifted = T;
    for (std::size_t k = 0; k < n; ++k) {
      truth.push_back(T);
      keyframes.push_back({static_cast<double>(k), drifted, {}});
      T = T * step(turn_rad, 2.0);
      drifted = drifted * step(turn_rad + 3e-4, 2.004);
    }
    paths_m = path_lengths_m(keyframes);
  }
  static Eigen::Isometry3d step(double turn_rad, double length_m) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation_from({0.0, 0.0, turn_rad});
    T.translation().x() = length_m;
    return T;
  }
  /// A loop, off by a motion.
  LoopCandidate loop(std::size_t from, std::size_t to,
                     const Eigen::Isometry3d& off = Eigen::Isometry3d::Identity()) const {
    LoopCandidate candidate;
    candidate.from = from;
    candidate.to = to;
    candidate.T_from_to = truth[from].inverse() * truth[to] * off;
    candidate.error_m = 0.02;
    candidate.accepted = true;
    return candidate;
  }
  double worst_m(const std::vector<Eigen::Isometry3d>& poses) const {
    double worst_m = 0.0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      worst_m = std::max(worst_m, (poses[k].translation() - truth[k].translation()).norm());
    }
    return worst_m;
  }
  std::vector<Eigen::Isometry3d> odometry() const {
    std::vector<Eigen::Isometry3d> poses;
    for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.T_world_body);
    return poses;
  }
  std::vector<Eigen::Isometry3d> truth;
  std::vector<Keyframe> keyframes;
  std::vector<double> paths_m;
  LoopOptions options;
};

Eigen::Isometry3d shifted(double x, double y) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << x, y, 0.0;
  return T;
}

TEST(LoopGraph, LoopsTakeOutTheDrift) {
  const TwoRounds way;
  LoopClosure closure;
  for (std::size_t k = 0; k < 150; k += 10) closure.candidates.push_back(way.loop(k, k + 157));
  close_graph(way.keyframes, way.options, closure);
  EXPECT_EQ(closure.n_loops, 15U);
  EXPECT_GT(way.worst_m(way.odometry()), 3.0);
  const Eigen::Isometry3d end = closure.poses.front().inverse() * closure.poses[157];
  EXPECT_LT((end.translation() - (way.truth[0].inverse() * way.truth[157]).translation()).norm(), 0.05);
  EXPECT_LT(way.worst_m(closure.poses), 0.5 * way.worst_m(way.odometry()));
  EXPECT_LT(closure.final_cost, 0.5 * closure.initial_cost);
  EXPECT_TRUE(closure.poses.front().isApprox(way.keyframes.front().T_world_body));
}

TEST(LoopGraph, APlantedWrongLoopIsNamedAndDropped) {
  const TwoRounds way;
  LoopClosure right, planted;
  for (std::size_t k = 0; k < 150; k += 10) right.candidates.push_back(way.loop(k, k + 157));
  planted.candidates = right.candidates;
  planted.candidates.insert(planted.candidates.begin() + 4, way.loop(35, 35 + 157, shifted(4.0, 2.0)));
  planted.candidates.insert(planted.candidates.begin() + 9, way.loop(70, 70 + 100));  // right
  planted.candidates.insert(planted.candidates.begin() + 9, way.loop(15, 15 + 78, shifted(0.0, 30.0)));
  close_graph(way.keyframes, way.options, right);
  close_graph(way.keyframes, way.options, planted);
  EXPECT_FALSE(planted.candidates[4].accepted);
  EXPECT_NE(planted.candidates[4].reason.find("contradicts"), std::string::npos);
  EXPECT_FALSE(planted.candidates[9].accepted);
  EXPECT_EQ(planted.n_loops, 16U);
  EXPECT_LT(way.worst_m(planted.poses), way.worst_m(right.poses) + 0.02);
}

TEST(LoopGraph, HeadingIsFreeAndRollAndPitchAreKept) {
  TwoRounds way;
  for (Keyframe& keyframe : way.keyframes) {  // all tilted in the world, as on a slope
    keyframe.T_world_body.linear() = keyframe.T_world_body.linear() * rotation_from({0.1, -0.05, 0.0});
  }
  std::vector<LoopCandidate> none;
  PoseGraph graph = loop_graph(way.keyframes, none, way.options);
  const double as_they_are = graph_cost(graph, graph.poses);
  EXPECT_NEAR(as_they_are, 0.0, 1e-12);
  const auto cost_after = [&](const Eigen::Vector3d& turn_rad) {
    std::vector<Eigen::Isometry3d> poses = graph.poses;
    for (Eigen::Isometry3d& T : poses) T = Eigen::Isometry3d(rotation_from(turn_rad)) * T;
    return graph_cost(graph, poses);
  };
  EXPECT_NEAR(cost_after({0.0, 0.0, 1.5}), 0.0, 1e-8);
  EXPECT_GT(cost_after({0.02, 0.0, 0.0}), 1000.0);
  way.options.gravity_sigma_deg = 0.0;
  graph = loop_graph(way.keyframes, none, way.options);
  EXPECT_NEAR(cost_after({0.02, 0.0, 0.0}), 0.0, 1e-8);
}

TEST(LoopGraph, WithoutLoopsOdometryStays) {
  const TwoRounds way;
  LoopClosure closure;
  closure.candidates.push_back(way.loop(0, 157));
  closure.candidates[0].accepted = false;
  close_graph(way.keyframes, way.options, closure);
  EXPECT_EQ(closure.n_loops, 0U);
  EXPECT_EQ(closure.largest_change_m, 0.0);
  for (std::size_t k = 0; k < closure.poses.size(); ++k) {
    EXPECT_TRUE(closure.poses[k].matrix() == way.keyframes[k].T_world_body.matrix());
  }
}

TEST(LoopConsistency, OneAgainstManyGoes) {
  const TwoRounds way;
  std::vector<LoopCandidate> candidates;
  for (std::size_t k = 20; k < 60; k += 5) candidates.push_back(way.loop(k, k + 157));
  candidates.push_back(way.loop(42, 42 + 157, shifted(3.0, 0.0)));
  reject_contradicted(candidates, way.keyframes, way.paths_m, way.options);
  for (std::size_t i = 0; i + 1 < candidates.size(); ++i) EXPECT_TRUE(candidates[i].accepted) << i;
  EXPECT_FALSE(candidates.back().accepted);
  EXPECT_NE(candidates.back().reason.find("contradict"), std::string::npos);
}

TEST(LoopConsistency, OfTwoThatContradictEachOtherTheWorseGoesAndALoneOneStays) {
  const TwoRounds way;
  std::vector<LoopCandidate> candidates{way.loop(20, 177), way.loop(25, 182, shifted(3.0, 0.0)), way.loop(120, 277)};
  candidates[0].verdict.score = 0.5;
  candidates[1].verdict.score = 0.7;
  reject_contradicted(candidates, way.keyframes, way.paths_m, way.options);
  EXPECT_FALSE(candidates[0].accepted);
  EXPECT_TRUE(candidates[1].accepted);
  EXPECT_TRUE(candidates[2].accepted);
}

}  // namespace
}  // namespace cmap
