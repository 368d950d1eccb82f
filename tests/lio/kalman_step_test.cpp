#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "filter/plane_rows.hpp"

namespace cmap {
namespace kalman_step_test {

using Eigen::Vector3d;

class Random {
 public:
  double normal() { return normal_(generator_); }
  Vector3d vector(double scale) { return scale * Vector3d(normal(), normal(), normal()); }
  StateMatrix covariance() {
    StateMatrix root;
    for (int i = 0; i < root.size(); ++i) root.data()[i] = normal();
    return 0.01 * (root * root.transpose() + StateMatrix::Identity());
  }

 private:
  std::mt19937_64 generator_{5};
  std::normal_distribution<double> normal_;
};

/// Rows that do not depend on the state.
struct FixedRows {
  Eigen::MatrixXd H;  ///< n x 18
  Eigen::VectorXd residuals, variances;
  PlaneSystem system;

  explicit FixedRows(Random& random, int n) : H(Eigen::MatrixXd::Zero(n, part::kAll)), residuals(n), variances(n) {
    for (int i = 0; i < n; ++i) {
      PlaneRow row;
      for (int k = 0; k < 6; ++k) row.jacobian[k] = random.normal();
      row.residual_m = random.normal();
      row.variance_m2 = 0.05 + 0.01 * i;
      H.row(i).head<6>() = row.jacobian.transpose();
      residuals[i] = row.residual_m;
      variances[i] = row.variance_m2;
      system.add(row, 1.0);
    }
  }
};

TEST(KalmanStep, OneDimensionByHand) {
  // Known to be at 0 with variance 4, measured 5 m too far with variance 1: back by 4 m, variance 0.8.
  StateMatrix P = 0.01 * StateMatrix::Identity(), after;
  P(part::kPosition, part::kPosition) = 4.0;
  PlaneRow row;
  row.residual_m = 5.0;
  row.variance_m2 = 1.0;
  row.jacobian[part::kPosition] = 1.0;
  PlaneSystem system;
  system.add(row, 1.0);
  const StateVector change = kalman_step({}, {}, P, system, after);
  EXPECT_NEAR(change[part::kPosition], -4.0, 1e-12);
  EXPECT_NEAR(after(part::kPosition, part::kPosition), 0.8, 1e-12);
  EXPECT_NEAR(after(part::kVelocity, part::kVelocity), 0.01, 1e-15) << "nothing was measured of it";
  EXPECT_NEAR(change.squaredNorm(), 16.0, 1e-10) << "nothing else moves";
}

TEST(KalmanStep, AWeightCountsAsRowsDo) {
  PlaneRow row;
  row.residual_m = 5.0;
  row.variance_m2 = 1.0;
  row.jacobian[part::kPosition] = 1.0;
  PlaneSystem twice, weighted;
  twice.add(row, 1.0);
  twice.add(row, 1.0);
  weighted.add(row, 2.0);
  EXPECT_EQ(twice.information, weighted.information);
  EXPECT_EQ(twice.gradient, weighted.gradient);
}

TEST(KalmanStep, IsTheTextbooksUpdateInGainForm) {
  Random random;
  for (const int n : {1, 3, 6, 40}) {
    const StateMatrix P = random.covariance();
    const FixedRows rows(random, n);
    StateMatrix after;
    const StateVector change = kalman_step({}, {}, P, rows.system, after);
    const Eigen::MatrixXd R = rows.variances.asDiagonal();
    const Eigen::MatrixXd K = P * rows.H.transpose() * (rows.H * P * rows.H.transpose() + R).inverse();
    const StateVector expected = -K * rows.residuals;
    const StateMatrix I_KH = StateMatrix::Identity() - K * rows.H;
    const StateMatrix joseph = I_KH * P * I_KH.transpose() + K * R * K.transpose();
    // Condition numbers of 1e4 to 1e6 leave ten digits.
    EXPECT_LT((change - expected).norm(), 1e-9 * expected.norm()) << n;
    EXPECT_LT((after - joseph).norm(), 1e-9 * P.norm()) << n;
    EXPECT_EQ(after, after.transpose());
  }
}

TEST(KalmanStep, FromElsewhereALinearStepEndsAtTheSamePlace) {
  Random random;
  const StateMatrix P = random.covariance();
  FixedRows rows(random, 12);
  StateMatrix after;
  const StateVector expected = kalman_step({}, {}, P, rows.system, after);
  // The same rows seen from an estimate that is elsewhere in all that is added: residuals by H (x - x0).
  StateVector elsewhere = StateVector::Zero();
  for (int i = part::kPosition; i < part::kAll; ++i) elsewhere[i] = random.normal();
  PlaneSystem system;
  for (int i = 0; i < 12; ++i) {
    PlaneRow row;
    row.jacobian = rows.H.row(i).head<6>().transpose();
    row.residual_m = rows.residuals[i] + rows.H.row(i).dot(elsewhere);
    row.variance_m2 = rows.variances[i];
    system.add(row, 1.0);
  }
  const StateVector change = kalman_step(moved({}, elsewhere), {}, P, system, after);
  EXPECT_LT((elsewhere + change - expected).norm(), 1e-9 * expected.norm());
}

TEST(KalmanStep, WithoutRowsGoesBackToThePrediction) {
  Random random;
  const StateMatrix P = random.covariance();
  NavState predicted;
  predicted.rotation = rotation_exp({0.2, -0.4, 0.3});
  StateVector away;
  for (int i = 0; i < part::kAll; ++i) away[i] = 0.3 * random.normal();
  NavState estimate = moved(predicted, away);
  StateMatrix after;
  for (int i = 0; i < 6; ++i) {
    estimate = moved(estimate, kalman_step(estimate, predicted, P, {}, after));
  }
  EXPECT_LT(difference(estimate, predicted).norm(), 1e-9);
  EXPECT_LT((after - P).norm(), 1e-9 * P.norm());
}

/// Points that are to lie on planes.
struct PlaneProblem {
  std::vector<Vector3d> points, normals, centers;
  NavState predicted;
  StateMatrix P;
  double variance_m2 = 1e-4;

  explicit PlaneProblem(Random& random) {
    predicted.rotation = rotation_exp({0.5, -0.8, 1.1});
    predicted.position = {3.0, -2.0, 1.0};
    P = 0.01 * random.covariance();
    StateVector error;
    for (int i = 0; i < part::kAll; ++i) error[i] = 0.1 * random.normal();
    const Eigen::Isometry3d truth = T_world_body(moved(predicted, error));
    for (int i = 0; i < 60; ++i) {
      points.push_back(random.vector(5.0));
      normals.push_back(random.vector(1.0).normalized());
      centers.push_back(truth * points.back() + random.vector(0.01));
    }
  }
  double residual(int i, const NavState& state) const {
    const auto k = static_cast<std::size_t>(i);
    return normals[k].dot(T_world_body(state) * points[k] - centers[k]);
  }
  PlaneSystem system(const NavState& state) const {
    PlaneSystem result;
    const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
    for (int i = 0; i < 60; ++i) {
      const auto k = static_cast<std::size_t>(i);
      result.add({residual(i, state), variance_m2, plane_jacobian(R, normals[k], points[k], 1.0)}, 1.0);
    }
    return result;
  }
  double cost(const NavState& state) const {
    const StateVector d = difference(state, predicted);
    double sum = d.dot(P.inverse() * d);
    for (int i = 0; i < 60; ++i) sum += residual(i, state) * residual(i, state) / variance_m2;
    return sum;
  }
  StateVector numeric_gradient(const NavState& state) const {
    StateVector gradient;
    for (int i = 0; i < part::kAll; ++i) {
      const StateVector d = 1e-5 * StateVector::Unit(i);
      gradient[i] = (cost(moved(state, d)) - cost(moved(state, -d))) / 2e-5;
    }
    return gradient;
  }
};

TEST(KalmanStep, RepeatedItFindsTheMinimumOfPriorAndRows) {
  Random random;
  const PlaneProblem problem(random);
  NavState estimate = problem.predicted;
  StateMatrix after;
  const double before = problem.numeric_gradient(estimate).norm();
  for (int i = 0; i < 20; ++i) {
    estimate = moved(estimate, kalman_step(estimate, problem.predicted, problem.P, problem.system(estimate), after));
  }
  EXPECT_GT(difference(estimate, problem.predicted).head<3>().norm(), 0.02) << "a turn to be found";
  // Rounding of the cost, some 1e4, by a step of 1e-5 leaves 1e-7.
  EXPECT_LT(problem.numeric_gradient(estimate).norm(), 1e-6 * before);
}

TEST(KalmanStep, PlaneJacobianIsTheDerivative) {
  Random random;
  const PlaneProblem problem(random);
  const Eigen::Matrix3d R = problem.predicted.rotation.toRotationMatrix();
  for (int i = 0; i < 10; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const PoseVector found = plane_jacobian(R, problem.normals[k], problem.points[k], 1.0);
    for (int axis = 0; axis < 6; ++axis) {
      const StateVector d = 1e-6 * StateVector::Unit(axis);
      const double numeric =
          (problem.residual(i, moved(problem.predicted, d)) - problem.residual(i, moved(problem.predicted, -d))) / 2e-6;
      EXPECT_NEAR(found[axis], numeric, 1e-8) << i << ", " << axis;
    }
  }
}

}  // namespace kalman_step_test
}  // namespace cmap
