#include <ceres/cost_function.h>

#include "cmap/graph/g2o_file.hpp"
#include "graph/graph_testing.hpp"
#include "io/real_data.hpp"
#include "link_error.hpp"
#include "solver.hpp"

// Optima of public pose graphs: of this module's cost (found independently, with automatic derivatives on quaternions
// and translations in blocks of their own), and of SE-Sync's, as its paper prints them (Rosen et al. 2019, tables).
namespace cmap::graph {
namespace published_optima_test {

/// SE-Sync's objective: kappa |R_j - R_i R_ij|_F^2 + tau |t_j - t_i - R_i t_ij|^2, kappa = 3 / (2 tr(Omega_r^-1)),
/// tau = 3 / tr(Omega_t^-1). With q the quaternion of R_ij^T R_i^T R_j, the first is kappa 2 |2 vec(q)|^2: the same
/// number from three residuals, where Gauss-Newton steps on nine converge slowly.
class SeSyncCost final : public ceres::CostFunction {
 public:
  explicit SeSyncCost(const Link& link) : relative_(link.relative) {
    const Matrix7d information = link.sqrt_information.transpose() * link.sqrt_information;
    const Eigen::Matrix3d by_translation = information.topLeftCorner<3, 3>();
    const Eigen::Matrix3d by_rotation = information.block<3, 3>(3, 3);
    weights_.head<3>().setConstant(std::sqrt(3.0 / by_translation.inverse().trace()));
    weights_.tail<3>().setConstant(std::sqrt(2.0 * 1.5 / by_rotation.inverse().trace()));
    set_num_residuals(6);
    mutable_parameter_block_sizes()->assign(2, kBlockSize);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Node from = node_at(blocks[0]), to = node_at(blocks[1]);
    LinkError error = link_error(from, to, relative_);
    Eigen::Quaterniond q = relative_.rotation.conjugate() * from.rotation.conjugate() * to.rotation;
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const Eigen::Matrix3d by_turn = q.w() * Eigen::Matrix3d::Identity() + cross_matrix(q.vec());
    error.by_from.block<3, 3>(3, 3) = -by_turn * (to.rotation.conjugate() * from.rotation).toRotationMatrix();
    error.by_to.block<3, 3>(3, 3) = by_turn;
    error.r.segment<3>(3) = 2.0 * q.vec();
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(residuals, 6) = weights_.cwiseProduct(error.r.head<6>());
    write(error.by_from, jacobians == nullptr ? nullptr : jacobians[0]);
    write(error.by_to, jacobians == nullptr ? nullptr : jacobians[1]);
    return true;
  }

 private:
  void write(const Matrix7d& derivative, double* jacobian) const {
    if (jacobian == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, 6, kBlockSize, Eigen::RowMajor>> out(jacobian);
    out.setZero();
    out.leftCols<6>() = weights_.asDiagonal() * derivative.topLeftCorner<6, 6>();
  }
  Node relative_;
  Eigen::Matrix<double, 6, 1> weights_;
};

/// SE-Sync's F as its paper writes it.
double sesync_objective(const NodeGraph& graph) {
  double F = 0.0;
  for (const Link& link : graph.links) {
    const Matrix7d information = link.sqrt_information.transpose() * link.sqrt_information;
    const Eigen::Matrix3d by_translation = information.topLeftCorner<3, 3>();
    const Eigen::Matrix3d by_rotation = information.block<3, 3>(3, 3);
    const Node &from = graph.nodes[link.from], &to = graph.nodes[link.to];
    const Eigen::Matrix3d R_i = from.rotation.toRotationMatrix();
    const Eigen::Matrix3d turn = to.rotation.toRotationMatrix() - R_i * link.relative.rotation.toRotationMatrix();
    const Eigen::Vector3d step = to.translation - from.translation - R_i * link.relative.translation;
    F += 1.5 / by_rotation.inverse().trace() * turn.squaredNorm();
    F += 3.0 / by_translation.inverse().trace() * step.squaredNorm();
  }
  return F;
}

class PublishedOptima : public testing::RealData {
 protected:
  PoseGraph read(const std::string& name) const { return read_g2o(folder_ / "g2o" / (name + ".g2o")).graph; }

  /// Optima are printed with nine digits and more; SE-Sync prints four.
  static constexpr double kRelative = 1e-4;

  void expect_optimum(const std::string& name, GraphStart start, double optimum) const {
    const PoseGraphResult result = optimize(read(name), {start});
    EXPECT_TRUE(result.converged) << name;
    EXPECT_NEAR(result.final_cost, optimum, kRelative * optimum) << name;
  }
  void expect_sesync_optimum(const std::string& name, double optimum) const {
    const PoseGraph graph = read(name);
    NodeGraph nodes = node_graph(graph, chordal_poses(graph));
    const auto cost = [](const Link& link) { return std::make_unique<SeSyncCost>(link); };
    const Outcome outcome = solve(nodes, cost, {});
    EXPECT_TRUE(outcome.converged) << name;
    EXPECT_NEAR(sesync_objective(nodes), optimum, kRelative * optimum) << name;
  }
};

TEST_F(PublishedOptima, SmallGridFromBothStarts) {
  expect_optimum("tinyGrid3D", GraphStart::kPoses, 18.6161577);
  expect_optimum("smallGrid3D", GraphStart::kPoses, 1033.89440);
  expect_optimum("smallGrid3D", GraphStart::kChordal, 1033.89440);
}

TEST_F(PublishedOptima, ParkingGarageFromBothStarts) {
  expect_optimum("parking-garage", GraphStart::kPoses, 1.26838440);
  expect_optimum("parking-garage", GraphStart::kChordal, 1.26838440);
}

TEST_F(PublishedOptima, SphereFromBothStarts) {
  expect_optimum("sphere2500", GraphStart::kPoses, 1351.36233);
  expect_optimum("sphere2500", GraphStart::kChordal, 1351.36233);
}

TEST_F(PublishedOptima, TorusFromTheLowerStart) {
  // From the poses in the file it ends at 59874, a local minimum.
  expect_optimum("torus3D", GraphStart::kLower, 24233.0187);
}

TEST_F(PublishedOptima, OfSeSync) {
  expect_sesync_optimum("tinyGrid3D", 18.5193664);
  expect_sesync_optimum("smallGrid3D", 1025.39806);
  expect_sesync_optimum("sphere2500", 1687.00581);
  expect_sesync_optimum("parking-garage", 1.26252443);
  expect_sesync_optimum("torus3D", 24227.0456);
}

TEST_F(PublishedOptima, TheOrderOfEdgesDoesNotMatter) {
  PoseGraph graph = read("smallGrid3D");
  std::ranges::reverse(graph.edges);
  const PoseGraphResult result = optimize(graph);
  EXPECT_NEAR(result.final_cost, 1033.89440, kRelative * 1033.89440);
}

}  // namespace published_optima_test
}  // namespace cmap::graph
