#include "link_error.hpp"

#include "graph/graph_testing.hpp"
#include "solver.hpp"

namespace cmap::graph {
namespace link_error_test {

Node random_node(std::mt19937_64& random, double reach_m = 5.0) {
  Node node{test::random_vector(random, reach_m), Eigen::Quaterniond(test::random_rotation(random)), 0.0};
  node.log_scale = test::uniform_in(random, -1.0, 1.0);
  return node;
}

Node nudged(Node node, int axis, double step) {
  if (axis < 3) node.translation[axis] += step;
  if (axis >= 3 && axis < 6) node.rotation = node.rotation * rotation_exp(step * Eigen::Vector3d::Unit(axis - 3));
  if (axis == 6) node.log_scale += step;
  return node;
}

TEST(Rotation, ExponentialAndLogarithm) {
  std::mt19937_64 random(1);
  for (const double size : {0.0, 1e-12, 1e-7, 1e-4, 0.1, 1.0, 3.1}) {
    const Eigen::Vector3d phi = size * test::random_vector(random, 1.0).normalized();
    // Close to pi the angle is known from its sine to 1e-16 / sin(angle / 2) of the quaternion: 1e-15.
    EXPECT_LT((rotation_log(rotation_exp(phi)) - phi).norm(), 4e-15 * std::max(1.0, size)) << size;
    EXPECT_LT((rotation_exp(phi).toRotationMatrix() - rotation_from(phi)).norm(), 1e-15 * 4) << size;
  }
  // Both signs of a quaternion are one rotation.
  const Eigen::Quaterniond q = rotation_exp({0.3, -0.2, 0.1});
  EXPECT_TRUE(rotation_log(Eigen::Quaterniond(-q.coeffs())).isApprox(Eigen::Vector3d(0.3, -0.2, 0.1), 1e-14));
}

TEST(LinkError, ByHand) {
  // From (1, 0, 0), turned by 90 degrees about z, scale 2, to (1, 4, 0), turned by 180 degrees, scale 6: 4 m ahead are
  // 2 units along x; a quarter turn; three times the scale.
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Node from{{1, 0, 0}, rotation_exp(M_PI_2 * z), std::log(2.0)};
  const Node to{{1, 4, 0}, rotation_exp(M_PI * z), std::log(6.0)};
  Vector7d expected;
  expected << 2, 0, 0, 0, 0, M_PI_2, std::log(3.0);
  EXPECT_LT((link_residual(from, to, {}) - expected).norm(), 1e-14);
  const Node measured{{2, 0, 0}, rotation_exp(M_PI_2 * z), std::log(3.0)};
  EXPECT_LT(link_residual(from, to, measured).norm(), 1e-14);
}

TEST(LinkError, DerivativesAreThoseOfTheResidual) {
  std::mt19937_64 random(2);
  constexpr double kStep = 1e-5;
  for (int trial = 0; trial < 50; ++trial) {
    const Node from = random_node(random), to = random_node(random);
    const Node relative = random_node(random);
    const LinkError error = link_error(from, to, relative);
    // Near pi the logarithm jumps, and differences across the jump mean nothing.
    if (error.r.segment<3>(3).norm() > 3.1) continue;
    for (int axis = 0; axis < 7; ++axis) {
      const Vector7d by_from = (link_residual(nudged(from, axis, kStep), to, relative) -
                                link_residual(nudged(from, axis, -kStep), to, relative)) /
                               (2.0 * kStep);
      const Vector7d by_to = (link_residual(from, nudged(to, axis, kStep), relative) -
                              link_residual(from, nudged(to, axis, -kStep), relative)) /
                             (2.0 * kStep);
      // Differences: rounding 1e-16 * 30 m / 1e-5, third derivatives times 1e-10.
      EXPECT_LT((error.by_from.col(axis) - by_from).norm(), 1e-7) << trial << " " << axis;
      EXPECT_LT((error.by_to.col(axis) - by_to).norm(), 1e-7) << trial << " " << axis;
    }
  }
}

TEST(LinkError, DerivativesOfSmallErrors) {
  // Where the series replaces the closed form, on both sides of the limit.
  for (const double angle : {0.0, 1e-9, 0.99e-3, 1.01e-3}) {
    const Eigen::Vector3d phi = angle * Eigen::Vector3d(1, 2, 2) / 3.0;
    constexpr double kStep = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double step) {
        return rotation_log(rotation_exp(phi) * rotation_exp(step * Eigen::Vector3d::Unit(axis)));
      };
      const Eigen::Vector3d difference = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
      EXPECT_LT((inverse_right_jacobian(phi).col(axis) - difference).norm(), 1e-8) << angle;
    }
  }
}

TEST(LinkError, CostFunctionIsTheWeightedError) {
  std::mt19937_64 random(3);
  for (const int dim : {6, 7}) {
    Link link{0, 1, random_node(random), Matrix7d::Zero(), Eigen::Vector3d::Zero(), 0.0};
    Node from = random_node(random), to = random_node(random);
    if (dim == 6) from.log_scale = to.log_scale = link.relative.log_scale = 0.0;
    for (int r = 0; r < dim; ++r) {
      for (int c = 0; c < dim; ++c) link.sqrt_information(r, c) = test::uniform_in(random, -1, 1);
    }
    const LinkError error = link_error(from, to, link.relative);
    const auto block = [](const Node& n) {
      return std::array<double, kBlockSize>{n.translation.x(), n.translation.y(), n.translation.z(), n.rotation.x(),
                                            n.rotation.y(),    n.rotation.z(),    n.rotation.w(),    n.log_scale};
    };
    const auto a = block(from), b = block(to);
    const double* blocks[] = {a.data(), b.data()};
    Eigen::VectorXd r(dim);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor by_from(dim, kBlockSize), by_to(dim, kBlockSize);
    double* jacobians[] = {by_from.data(), by_to.data()};
    ASSERT_TRUE(log_cost(link, dim)->Evaluate(blocks, r.data(), jacobians));
    const Eigen::MatrixXd U = link.sqrt_information.topLeftCorner(dim, dim);
    EXPECT_TRUE(r.isApprox(U * error.r.head(dim), 1e-14));
    EXPECT_TRUE(by_from.leftCols(dim).isApprox(U * error.by_from.topLeftCorner(dim, dim), 1e-14));
    EXPECT_TRUE(by_to.leftCols(dim).isApprox(U * error.by_to.topLeftCorner(dim, dim), 1e-14));
    EXPECT_EQ(by_to.rightCols(kBlockSize - dim).norm(), 0.0);
  }
}

}  // namespace link_error_test
}  // namespace cmap::graph
