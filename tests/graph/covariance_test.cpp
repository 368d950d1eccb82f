#include "graph/graph_testing.hpp"

namespace cmap {
namespace covariance_test {

using ::testing::HasSubstr;

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Eigen::VectorXd& d) {
  return test::nudged(pose, d.head<3>(), d.segment<3>(3));
}
Similarity moved(const Similarity& pose, const Eigen::VectorXd& d) {
  return test::with_scale(pose.scale * std::exp(d[6]), moved(test::rigid_part(pose), d));
}

/// Half the matrix of second differences of the cost by the small motions of all nodes but the first. Where all
/// residuals are zero it is the information.
template <class Graph>
Eigen::MatrixXd information_by_differences(const Graph& graph, int dim) {
  constexpr double kStep = 1e-4;
  const auto n = static_cast<int>(graph.poses.size()) - 1;
  const auto cost = [&](const Eigen::VectorXd& motion) {
    auto poses = graph.poses;
    for (int i = 0; i < n; ++i) {
      auto& pose = poses[static_cast<std::size_t>(i + 1)];
      pose = moved(pose, motion.segment(i * dim, dim));
    }
    return graph_cost(graph, poses);
  };
  const int size = n * dim;
  Eigen::MatrixXd H(size, size);
  const auto unit = [&](int i) -> Eigen::VectorXd { return kStep * Eigen::VectorXd::Unit(size, i); };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      H(i, j) =
          (cost(unit(i) + unit(j)) - cost(unit(i) - unit(j)) - cost(unit(j) - unit(i)) + cost(-unit(i) - unit(j))) /
          (8.0 * kStep * kStep);
    }
  }
  return H;
}

template <class Graph>
void expect_dense_inverse(const Graph& graph, int dim) {
  const Eigen::MatrixXd dense = information_by_differences(graph, dim).inverse();
  const std::vector<std::size_t> nodes{3, 0, 1};
  const auto found = node_covariances(graph, graph.poses, nodes);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1].norm(), 0.0) << "node 0 is fixed";
  for (const std::size_t k : {0u, 2u}) {
    const int slot = static_cast<int>(nodes[k] - 1) * dim;
    // Differences: steps of 1e-4 over residuals of order 10 with conditions of 1e2.
    EXPECT_TRUE(found[k].isApprox(dense.block(slot, slot, dim, dim), 1e-4)) << found[k] << "\n\n"
                                                                            << dense.block(slot, slot, dim, dim);
  }
}

TEST(Covariance, IsTheDenseInverse) { expect_dense_inverse(test::exact_graph(6, 21), 6); }

TEST(Covariance, IsTheDenseInverseWithScales) { expect_dense_inverse(test::exact_scaled_graph(5, 22), 7); }

TEST(Covariance, OfOneEdgeByHand) {
  // One edge from the origin: the covariance is the inverse of its information; a second, equal edge halves it.
  std::mt19937_64 random(23);
  PoseGraph graph;
  graph.poses = {Eigen::Isometry3d::Identity(), test::pose_of(Eigen::Matrix3d::Identity(), {1, 2, 3})};
  graph.edges = {{0, 1, graph.poses[1], test::random_information<6>(random), 0.0}};
  const std::vector<std::size_t> nodes{1};
  const Eigen::MatrixXd inverse = graph.edges[0].information.inverse();
  EXPECT_TRUE(node_covariances(graph, graph.poses, nodes)[0].isApprox(inverse, 1e-12));
  graph.edges.push_back(graph.edges[0]);
  EXPECT_TRUE(node_covariances(graph, graph.poses, nodes)[0].isApprox(0.5 * inverse, 1e-12));
}

TEST(Covariance, DoubtfulEdgesCountLess) {
  // An edge off by 3 standard deviations with width 1 has the weight 1 / (1 + 9).
  PoseGraph graph;
  graph.poses.assign(2, Eigen::Isometry3d::Identity());
  graph.edges = {
      {0, 1, test::pose_of(Eigen::Matrix3d::Identity(), {3, 0, 0}), PoseGraph::Information::Identity(), 1.0}};
  const std::vector<std::size_t> nodes{1};
  EXPECT_NEAR(node_covariances(graph, graph.poses, nodes)[0](0, 0), 10.0, 1e-12);
}

TEST(Covariance, GrowsAlongAChain) {
  PoseGraph graph;
  graph.poses.assign(5, Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < 4; ++i) {
    graph.edges.push_back({i, i + 1, Eigen::Isometry3d::Identity(), 4.0 * PoseGraph::Information::Identity(), 0.0});
  }
  const std::vector<std::size_t> nodes{1, 2, 3, 4};
  const auto covariances = node_covariances(graph, graph.poses, nodes);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_TRUE(covariances[k].isApprox(0.25 * static_cast<double>(k + 1) * PoseGraph::Information::Identity(), 1e-12));
  }
}

TEST(Covariance, RefusesWhatIsFree) {
  PoseGraph graph = test::exact_graph(4, 24);
  graph.fixed = {};
  PoseGraph::Information position_only = PoseGraph::Information::Zero();
  position_only.topLeftCorner<3, 3>().setIdentity();
  graph.priors = {{0, graph.poses[0], position_only, 0.0}};
  const std::vector<std::size_t> nodes{2};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { node_covariances(graph, graph.poses, nodes); }),
              HasSubstr("leave something free"));
  // Two more positions hold the rotation as well.
  graph.priors.push_back({1, graph.poses[1], position_only, 0.0});
  graph.priors.push_back({3, graph.poses[3], position_only, 0.0});
  EXPECT_EQ(test::refusal_of<UnsupportedError>([&] { node_covariances(graph, graph.poses, nodes); }), "");
  const std::vector<std::size_t> none{4};
  EXPECT_THROW(node_covariances(graph, graph.poses, none), std::invalid_argument);
}

}  // namespace covariance_test
}  // namespace cmap
