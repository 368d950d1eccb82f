#include "cmap/graph/pose_graph.hpp"

#include "cmap/core/execution.hpp"
#include "graph/graph_testing.hpp"

namespace cmap {
namespace pose_graph_test {

using test::pose_of;
using ::testing::HasSubstr;

/// A pose on the x axis, turned about it: steps along the axis and turns about it do not disturb each other.
Eigen::Isometry3d on_axis(double x_m, double turn_rad) { return pose_of(rotation_from({turn_rad, 0, 0}), {x_m, 0, 0}); }

PoseGraph::Information weights(double translation, double rotation) {
  PoseGraph::Information information = PoseGraph::Information::Identity() * translation;
  information.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * rotation;
  return information;
}

double largest_displacement(std::span<const Eigen::Isometry3d> a, std::span<const Eigen::Isometry3d> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i].matrix() - b[i].matrix()).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// 0 -> 1 -> 2 -> 0: the steps miss the start by 0.3 m, the turns by 0.6 rad.
PoseGraph triangle() {
  PoseGraph graph;
  graph.poses = {on_axis(0, 0), on_axis(1, 0.5), on_axis(2.5, 1.5)};
  graph.edges = {{0, 1, on_axis(1.0, 0.7), weights(10.0, 100.0), 0.0},
                 {1, 2, on_axis(1.5, 1.1), weights(20.0, 50.0), 0.0},
                 {2, 0, on_axis(-2.2, -1.2), weights(5.0, 200.0), 0.0}};
  return graph;
}

TEST(PoseGraph, ATriangleByHand) {
  // A loop's error e is shared in proportion to 1 / w, and costs e^2 / sum(1 / w).
  const double cost = 0.3 * 0.3 / (1 / 10.0 + 1 / 20.0 + 1 / 5.0) + 0.6 * 0.6 / (1 / 100.0 + 1 / 50.0 + 1 / 200.0);
  const double x1 = 1.0 - 0.3 * (1 / 10.0) / 0.35, x2 = x1 + 1.5 - 0.3 * (1 / 20.0) / 0.35;
  const double turn1 = 0.7 - 0.6 * 0.01 / 0.035, turn2 = turn1 + 1.1 - 0.6 * 0.02 / 0.035;
  for (const GraphStart start : {GraphStart::kPoses, GraphStart::kChordal, GraphStart::kLower, GraphStart::kBoth}) {
    const PoseGraphResult result = optimize(triangle(), {start});
    EXPECT_TRUE(result.converged);
    // The cost changes by less than 1e-10 of itself in the last step, the poses by about the root of that.
    EXPECT_NEAR(result.final_cost, cost, 1e-9 * cost);
    EXPECT_LT((result.poses[1].matrix() - on_axis(x1, turn1).matrix()).norm(), 1e-6);
    EXPECT_LT((result.poses[2].matrix() - on_axis(x2, turn2).matrix()).norm(), 1e-6);
    EXPECT_EQ(result.poses[0].matrix(), Eigen::Matrix4d::Identity());
    ASSERT_EQ(result.edge_costs.size(), 3u);
    EXPECT_NEAR(result.edge_costs[0] + result.edge_costs[1] + result.edge_costs[2], cost, 1e-9 * cost);
    EXPECT_EQ(result.chordal_start && start == GraphStart::kPoses, false);
    EXPECT_EQ(result.chordal_start || start != GraphStart::kChordal, true);
  }
}

TEST(PoseGraph, CostByHand) {
  PoseGraph graph = triangle();
  // Errors: 0, -0.2; 0, -0.1; -0.3, -0.3.
  const double e2 = 5 * 0.3 * 0.3 + 200 * 0.3 * 0.3;
  EXPECT_NEAR(graph_cost(graph, graph.poses), 100 * 0.04 + 50 * 0.01 + e2, 1e-10);
  EXPECT_NEAR(optimize(graph).initial_cost, 100 * 0.04 + 50 * 0.01 + e2, 1e-10);
  graph.edges[2].cauchy_width = 2.0;
  graph.priors.push_back({1, on_axis(0.8, 0.5), weights(3.0, 1.0), 0.0});
  const double robust = 4.0 * std::log(1.0 + e2 / 4.0);
  EXPECT_NEAR(graph_cost(graph, graph.poses), 100 * 0.04 + 50 * 0.01 + robust + 3.0 * 0.04, 1e-10);
}

TEST(PoseGraph, ExactMeasurementsAreMet) {
  const PoseGraph truth = test::exact_graph(30, 1);
  PoseGraph graph = truth;
  std::mt19937_64 random(2);
  for (std::size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i] = test::nudged(graph.poses[i], random, 0.3);
  const PoseGraphResult result = optimize(graph, {GraphStart::kPoses});
  EXPECT_GT(result.initial_cost, 1.0);
  // Quadratic convergence ends at rounding: coordinates of 10 m, conditions of 1e3.
  EXPECT_LT(result.final_cost, 1e-16);
  EXPECT_LT(largest_displacement(result.poses, truth.poses), 1e-8);
}

TEST(PoseGraph, ChordalPosesOfExactMeasurements) {
  const PoseGraph truth = test::exact_graph(40, 3);
  PoseGraph graph = truth;
  for (std::size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i].setIdentity();
  EXPECT_LT(largest_displacement(chordal_poses(graph), truth.poses), 1e-10);
  // Held by a prior in place of a fixed node, and by fixed nodes at both ends.
  graph.fixed = {};
  graph.priors = {{7, truth.poses[7], test::exact_graph(2, 4).edges[0].information, 0.0}};
  EXPECT_LT(largest_displacement(chordal_poses(graph), truth.poses), 1e-10);
  graph.priors.clear();
  graph.fixed = {0, 39, 20};
  for (const std::size_t i : graph.fixed) graph.poses[i] = truth.poses[i];
  const auto poses = chordal_poses(graph);
  EXPECT_LT(largest_displacement(poses, truth.poses), 1e-10);
  EXPECT_EQ(poses[39].matrix(), truth.poses[39].matrix());
}

PoseGraph noisy_graph(unsigned seed) {
  PoseGraph graph = test::exact_graph(12, seed);
  std::mt19937_64 random(seed + 100);
  for (auto& edge : graph.edges) edge.T_from_to = test::nudged(edge.T_from_to, random, 0.2);
  graph.edges[5].cauchy_width = 0.5;
  graph.priors.push_back({8, test::nudged(graph.poses[8], random, 0.5), test::random_information<6>(random), 1.0});
  return graph;
}

TEST(PoseGraph, NoPerturbationHasALowerCost) {
  const PoseGraph graph = noisy_graph(5);
  GraphOptions options;
  options.function_tolerance = 1e-14;
  const PoseGraphResult result = optimize(graph, options);
  EXPECT_NEAR(graph_cost(graph, result.poses), result.final_cost, 1e-10 * result.final_cost);
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 5000; ++trial) {
    const double size = std::pow(10.0, test::uniform_in(random, -5.0, -0.5));
    std::vector<Eigen::Isometry3d> poses = result.poses;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      if (trial % 2 == 0 || i == 1 + static_cast<std::size_t>(trial) % 11)
        poses[i] = test::nudged(poses[i], random, size);
    }
    ASSERT_GE(graph_cost(graph, poses), result.final_cost * (1.0 - 1e-12));
  }
}

TEST(PoseGraph, TheWorldMayBeAnyOther) {
  const PoseGraph graph = noisy_graph(7);
  std::mt19937_64 random(8);
  const Eigen::Isometry3d move = test::random_pose(random, 100.0);
  PoseGraph moved = graph;
  // Translations of priors are weighed in the world's axes, which turn as well.
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Identity();
  turn.topLeftCorner<3, 3>() = move.linear();
  for (auto& pose : moved.poses) pose = move * pose;
  for (auto& prior : moved.priors) {
    prior.T_world_node = move * prior.T_world_node;
    prior.information = turn * prior.information * turn.transpose();
  }
  GraphOptions options;
  options.function_tolerance = 1e-14;
  const PoseGraphResult a = optimize(graph, options), b = optimize(moved, options);
  EXPECT_NEAR(a.final_cost, b.final_cost, 1e-9 * a.final_cost);
  std::vector<Eigen::Isometry3d> expected = a.poses;
  for (auto& pose : expected) pose = move * pose;
  EXPECT_LT(largest_displacement(b.poses, expected), 1e-5);
}

TEST(PoseGraph, PriorsAreAveragedByTheirInformation) {
  PoseGraph graph;
  graph.poses = {Eigen::Isometry3d::Identity()};
  graph.fixed = {};
  graph.priors = {{0, on_axis(1, 0.2), weights(1, 3), 0.0}, {0, on_axis(4, 0.6), weights(2, 1), 0.0}};
  const PoseGraphResult result = optimize(graph);
  EXPECT_LT((result.poses[0].matrix() - on_axis(3, 0.3).matrix()).norm(), 1e-8);
  EXPECT_NEAR(result.final_cost, 1 * 4 + 2 * 1 + 3 * 0.01 + 1 * 0.09, 1e-9);
}

TEST(PoseGraph, RobustPriorsAgainstASearch) {
  // x^2 + c^2 log(1 + (d - x)^2 / c^2) over x, minimized by trying: the near one of several minima.
  for (const double d : {0.5, 2.0, 8.0}) {
    PoseGraph graph;
    graph.poses = {Eigen::Isometry3d::Identity()};
    graph.fixed = {};
    graph.priors = {{0, on_axis(0, 0), weights(1, 1), 0.0}, {0, on_axis(d, 0), weights(1, 1), 1.0}};
    double best = 0.0, lowest = std::numeric_limits<double>::infinity();
    for (double x = 0.0; x <= d; x += 1e-5) {
      const double cost = x * x + std::log1p((d - x) * (d - x));
      if (cost < lowest) lowest = cost, best = x;
    }
    const PoseGraphResult result = optimize(graph, {GraphStart::kPoses});
    EXPECT_NEAR(result.poses[0].translation().x(), best, 2e-5) << d;
    EXPECT_NEAR(result.final_cost, lowest, 1e-8) << d;
  }
}

TEST(PoseGraph, AWrongLoopIsVotedDownByItsWidth) {
  PoseGraph graph = test::exact_graph(20, 9);
  for (auto& edge : graph.edges) edge.information *= 1e3;
  const std::vector<Eigen::Isometry3d> truth = graph.poses;
  std::mt19937_64 random(10);
  graph.edges.push_back({2, 17, test::random_pose(random, 10.0), weights(100, 100), 0.0});
  EXPECT_GT(largest_displacement(optimize(graph, {GraphStart::kPoses}).poses, truth), 0.5);
  graph.edges.back().cauchy_width = 1.0;
  // Its weight falls as 1 / r^2: 1e-4 at a whitened error of 100.
  EXPECT_LT(largest_displacement(optimize(graph, {GraphStart::kPoses}).poses, truth), 0.05);
}

TEST(PoseGraph, LoopsFromAFoldedStart) {
  // A ring whose nodes all start in one place: chordal poses find it.
  const std::size_t n = 24;
  PoseGraph graph;
  graph.poses.assign(n, Eigen::Isometry3d::Identity());
  std::vector<Eigen::Isometry3d> truth(n, Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d step = pose_of(rotation_from({0, 0, 2 * M_PI / static_cast<double>(n)}), {1, 0, 0});
  for (std::size_t i = 0; i < n; ++i) {
    graph.edges.push_back({i, (i + 1) % n, step, weights(100, 1000), 0.0});
    if (i > 0) truth[i] = truth[i - 1] * step;
  }
  const PoseGraphResult result = optimize(graph);
  EXPECT_TRUE(result.chordal_start);
  EXPECT_LT(result.start_cost, 1e-15);
  EXPECT_LT(largest_displacement(result.poses, truth), 1e-8);
}

TEST(ScaledPoseGraph, ALoopOfScalesByHand) {
  // log scales 0.2 + 0.3 - 0.2 miss zero by 0.3: shared as 1 / w.
  ScaledPoseGraph graph;
  graph.poses.assign(3, {});
  const auto edge = [](std::size_t i, std::size_t j, double log_scale, double weight) {
    ScaledPoseGraph::Information information = ScaledPoseGraph::Information::Identity();
    information(6, 6) = weight;
    return ScaledPoseGraph::Edge{i, j, {.scale = std::exp(log_scale)}, information, 0.0};
  };
  graph.edges = {edge(0, 1, 0.2, 10.0), edge(1, 2, 0.3, 20.0), edge(2, 0, -0.2, 5.0)};
  const ScaledPoseGraphResult result = optimize(graph);
  EXPECT_NEAR(result.final_cost, 0.09 / 0.35, 1e-10);
  EXPECT_NEAR(std::log(result.poses[1].scale), 0.2 - 0.3 * 0.1 / 0.35, 1e-6);
  EXPECT_NEAR(std::log(result.poses[2].scale), 0.5 - 0.3 * 0.15 / 0.35, 1e-6);
}

TEST(ScaledPoseGraph, RecoversScales) {
  const ScaledPoseGraph truth = test::exact_scaled_graph(30, 11);
  ScaledPoseGraph graph = truth;
  for (std::size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i] = {};
  const std::vector<Similarity> chordal = chordal_poses(graph);
  const ScaledPoseGraphResult result = optimize(graph);
  EXPECT_LT(result.final_cost, 1e-16);
  std::mt19937_64 random(12);
  for (std::size_t i = 1; i < graph.poses.size(); ++i) {
    const double scale = truth.poses[i].scale * test::uniform_in(random, 0.8, 1.25);
    graph.poses[i] = test::with_scale(scale, test::nudged(test::rigid_part(truth.poses[i]), random, 0.2));
  }
  const ScaledPoseGraphResult near = optimize(graph, {GraphStart::kPoses});
  EXPECT_FALSE(near.chordal_start);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    for (const Similarity& pose : {chordal[i], result.poses[i], near.poses[i]}) {
      EXPECT_NEAR(pose.scale, truth.poses[i].scale, 1e-8);
      EXPECT_LT((test::rigid_part(pose).matrix() - test::rigid_part(truth.poses[i]).matrix()).norm(), 1e-7);
    }
  }
}

TEST(ScaledPoseGraph, WithScalesHeldItIsTheRigidGraph) {
  const PoseGraph rigid = noisy_graph(13);
  ScaledPoseGraph scaled;
  constexpr double kStiff = 1e8;
  const auto widened = [](const PoseGraph::Information& information) {
    ScaledPoseGraph::Information wide = ScaledPoseGraph::Information::Zero();
    wide.topLeftCorner<6, 6>() = information;
    wide(6, 6) = kStiff;
    return wide;
  };
  for (const auto& pose : rigid.poses) scaled.poses.push_back(test::with_scale(1.0, pose));
  for (const auto& e : rigid.edges) {
    scaled.edges.push_back({e.from, e.to, test::with_scale(1.0, e.T_from_to), widened(e.information), e.cauchy_width});
  }
  for (const auto& p : rigid.priors) {
    scaled.priors.push_back({p.node, test::with_scale(1.0, p.T_world_node), widened(p.information), p.cauchy_width});
  }
  const PoseGraphResult a = optimize(rigid);
  const ScaledPoseGraphResult b = optimize(scaled);
  // Forces of order 10 on scales held by 1e8.
  EXPECT_NEAR(b.final_cost, a.final_cost, 1e-5 * a.final_cost);
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_NEAR(b.poses[i].scale, 1.0, 1e-5);
    EXPECT_LT((test::rigid_part(b.poses[i]).matrix() - a.poses[i].matrix()).norm(), 1e-3);
  }
}

TEST(PoseGraph, TheSameForAnyNumberOfThreads) {
  const PoseGraph graph = noisy_graph(14);
  const PoseGraphResult all = optimize(graph, {GraphStart::kBoth});
  const ExecutionScope one({.threads = 1});
  const PoseGraphResult single = optimize(graph, {GraphStart::kBoth});
  EXPECT_EQ(all.final_cost, single.final_cost);
  EXPECT_EQ(largest_displacement(all.poses, single.poses), 0.0);
}

TEST(PoseGraph, NothingToMove) {
  PoseGraph graph;
  graph.poses = {Eigen::Isometry3d::Identity()};
  const PoseGraphResult result = optimize(graph, {GraphStart::kBoth});
  EXPECT_EQ(result.final_cost, 0.0);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.poses.size(), 1u);
}

TEST(PoseGraph, SemidefiniteInformation) {
  // Positions alone are known of the second node: its rotation is free, and an edge gives it.
  PoseGraph graph = triangle();
  graph.priors = {{1, on_axis(1, 0), weights(1, 0), 0.0}};
  EXPECT_TRUE(optimize(graph).converged);
  // Without any rotation the chordal start fails, with a word about it; the graph's own poses serve.
  for (auto& edge : graph.edges) edge.information = weights(1, 0);
  const PoseGraphResult result = optimize(graph);
  EXPECT_FALSE(result.chordal_start);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings[0], HasSubstr("rotation free"));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { optimize(graph, {GraphStart::kChordal}); }),
              HasSubstr("rotation free"));
}

TEST(PoseGraph, SaysWhenItHasNotConverged) {
  PoseGraph graph = noisy_graph(15);
  std::mt19937_64 random(16);
  for (std::size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i] = test::nudged(graph.poses[i], random, 0.5);
  GraphOptions options{GraphStart::kPoses};
  options.max_iterations = 1;
  const PoseGraphResult result = optimize(graph, options);
  EXPECT_FALSE(result.converged);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0], HasSubstr("not converged after 1 iterations"));
}

TEST(PoseGraph, RefusesNodesThatNothingHolds) {
  PoseGraph graph = triangle();
  graph.poses.push_back(on_axis(9, 0));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { optimize(graph); }),
              HasSubstr("node 3 of the pose graph is connected to no fixed"));
  graph.priors = {{3, on_axis(9, 0), weights(1, 1), 0.0}};
  EXPECT_EQ(test::refusal_of<UnsupportedError>([&] { optimize(graph); }), "");
  graph.fixed = {};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { optimize(graph); }), HasSubstr("node 0 of the pose graph"));
}

/// What std::invalid_argument says; empty if there is none.
std::string malformed(const PoseGraph& graph) {
  try {
    optimize(graph);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(PoseGraph, RefusesMalformedGraphs) {
  const PoseGraph good = triangle();
  EXPECT_EQ(malformed(good), "");
  const auto refused = [&](auto&& change) {
    PoseGraph graph = good;
    change(graph);
    return malformed(graph);
  };
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[1].to = 3; }), HasSubstr("edge 1 (1 to 3): there are 3 nodes"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[1].to = 1; }), HasSubstr("edge 1 (1 to 1) leads back"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.fixed = {5}; }), HasSubstr("node 5 is fixed"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.poses[2].translation().x() = NAN; }), HasSubstr("node 2 is not finite"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.poses[2].linear() *= 2; }), HasSubstr("node 2 has no rotation"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].information(1, 0) = 1; }), HasSubstr("is not symmetric"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].information(0, 0) = -1; }), HasSubstr("not positive semidefinite"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].information(0, 0) = INFINITY; }), HasSubstr("is not finite"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].cauchy_width = -1; }), HasSubstr("the width -1"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.priors = {{4, {}, {}, 0.0}}; }), HasSubstr("prior 0 (node 4)"));
  EXPECT_THROW(graph_cost(good, std::span(good.poses).first(2)), std::invalid_argument);
  ScaledPoseGraph scaled = test::exact_scaled_graph(3, 1);
  scaled.poses[1].scale = 0.0;
  EXPECT_THROW(optimize(scaled), std::invalid_argument);
}

TEST(PoseGraph, ChecksItsOptions) {
  GraphOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(optimize(triangle(), options), UsageError);
  options = {};
  options.function_tolerance = 0.0;
  EXPECT_THROW(optimize(triangle(), options), UsageError);
}

}  // namespace pose_graph_test
}  // namespace cmap
