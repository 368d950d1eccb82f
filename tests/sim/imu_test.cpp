#include "cmap/sim/imu.hpp"

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "sim/sensor_testing.hpp"

namespace cmap {
namespace imu_test {

using testing::rms;
using testing::walk;

ImuOptions ideal(double rate_hz) {
  ImuOptions options;
  options.rate_hz = rate_hz;
  options.gyro_noise_density_radps_per_sqrt_hz = options.accelerometer_noise_density_mps2_per_sqrt_hz = 0.0;
  options.gyro_bias_walk_radps2_per_sqrt_hz = options.accelerometer_bias_walk_mps3_per_sqrt_hz = 0.0;
  options.gyro_bias_radps = options.accelerometer_bias_mps2 = 0.0;
  return options;
}

/// A long hover without sway: all that is measured but +g is error.
PoseSpline still(double seconds) {
  PathOptions options;
  options.hold_s = seconds;
  options.knot_spacing_s = 0.2;
  return make_path({{0, 0, 0}}, options, 1);
}

TEST(Imu, AtRestReadsGravityUpwards) {
  const auto samples = simulate_imu(still(5.0), ideal(200.0), 1);
  EXPECT_EQ(samples.size(), 1u + static_cast<std::size_t>(std::floor(still(5.0).end_s() * 200.0 + 1e-6)));
  for (const ImuSample& s : samples) {
    EXPECT_TRUE(s.specific_force_mps2.isApprox(Eigen::Vector3d(0, 0, 9.81), 1e-14));
    EXPECT_LT(s.angular_rate_radps.norm(), 1e-15);
  }
  EXPECT_EQ(samples[7].time_s, 7 / 200.0);
}

/// Attitude, velocity and position integrated over pairs of sample intervals, fourth order: Simpson's rule, and the
/// Magnus series of a rate that changes linearly.
class Integrator {
 public:
  Integrator(const Motion& start)
      : R(start.T_world_body.linear()), v(start.velocity_mps), p(start.T_world_body.translation()) {}
  void step(const ImuSample& a, const ImuSample& b, const ImuSample& c) {
    const double H = c.time_s - a.time_s;
    const Eigen::Vector3d &w0 = a.angular_rate_radps, &w1 = b.angular_rate_radps, &w2 = c.angular_rate_radps;
    const Eigen::Matrix3d R1 = R * turn(H / 24.0 * (5 * w0 + 8 * w1 - w2) + H * H / 48.0 * w0.cross(w1));
    const Eigen::Matrix3d R2 = R * turn(H / 6.0 * (w0 + 4 * w1 + w2) + H * H / 12.0 * w0.cross(w2));
    const Eigen::Vector3d g(0, 0, 9.81);
    const Eigen::Vector3d a0 = R * a.specific_force_mps2 - g, a1 = R1 * b.specific_force_mps2 - g,
                          a2 = R2 * c.specific_force_mps2 - g;
    p += H * v + H * H / 6.0 * (a0 + 2 * a1);
    v += H / 6.0 * (a0 + 4 * a1 + a2);
    R = R2;
  }
  Eigen::Matrix3d R;
  Eigen::Vector3d v, p;

 private:
  static Eigen::Matrix3d turn(const Eigen::Vector3d& angles) {
    return angles.norm() > 0.0 ? Eigen::AngleAxisd(angles.norm(), angles.normalized()).toRotationMatrix()
                               : Eigen::Matrix3d::Identity();
  }
};

TEST(Imu, NoiseFreeSamplesIntegrateToThePath) {
  const PoseSpline path = walk();
  ASSERT_GT(path.end_s(), 60.0);
  const auto samples = simulate_imu(path, ideal(400.0), 1);
  Integrator integrator(path.motion(0.0));
  double furthest = 0.0;
  for (std::size_t i = 0; i + 2 < samples.size() && samples[i + 2].time_s <= 60.0; i += 2) {
    integrator.step(samples[i], samples[i + 1], samples[i + 2]);
    furthest = std::max(furthest, (integrator.p - path.pose(samples[i + 2].time_s).translation()).norm());
  }
  EXPECT_LT(furthest, 1e-3) << "over 60 s of walking, with rests, corners and sway";
  EXPECT_GT((path.pose(60.0).translation() - path.pose(0.0).translation()).norm(), 1.0);
}

TEST(Imu, LeverArmAddsWhatTurnsAdd) {
  const PoseSpline path = walk();
  ImuOptions options = ideal(100.0);
  options.accelerometer_lever_arm_m = {0.3, -0.2, 0.1};
  const auto place = [&](double t) -> Eigen::Vector3d { return path.pose(t) * options.accelerometer_lever_arm_m; };
  // Second differences over h: rounding 1e-14 / h^2 = 1e-8, bend h^2 / 12 of fourth derivatives, of jerk at a knot h.
  constexpr double h = 1e-3;
  for (double t = 3.03; t < 40.0; t += 0.513) {
    const Eigen::Vector3d a = (place(t + h) - 2 * place(t) + place(t - h)) / (h * h);
    const Eigen::Vector3d expected = path.pose(t).linear().transpose() * (a + Eigen::Vector3d(0, 0, 9.81));
    EXPECT_LT((ideal_imu_sample(path.motion(t), t, options).specific_force_mps2 - expected).norm(), 2e-3);
  }
}

/// Allan deviation at an averaging time of n samples, over all axes of one sensor.
double allan_deviation(const std::vector<Eigen::Vector3d>& values, std::size_t n) {
  std::vector<double> differences;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t begin = 0; begin + n <= values.size(); begin += n) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = begin; i < begin + n; ++i) mean += values[i] / static_cast<double>(n);
    if (begin > 0) {
      for (const double d : Eigen::Vector3d(mean - before)) differences.push_back(d);
    }
    before = mean;
  }
  return rms(differences) / std::sqrt(2.0);
}

struct Errors {
  std::vector<Eigen::Vector3d> gyro, accelerometer;
};

Errors errors(const ImuOptions& options, double seconds) {
  Errors e;
  for (const ImuSample& s : simulate_imu(still(seconds), options, 11)) {
    e.gyro.push_back(s.angular_rate_radps);
    e.accelerometer.push_back(s.specific_force_mps2 - Eigen::Vector3d(0, 0, 9.81));
  }
  return e;
}

TEST(Imu, WhiteNoiseHasItsDensity) {
  ImuOptions options = ideal(200.0);
  options.gyro_noise_density_radps_per_sqrt_hz = 3e-4;
  options.accelerometer_noise_density_mps2_per_sqrt_hz = 2e-3;
  const Errors e = errors(options, 2000.0);
  // White noise: density / sqrt(averaging time). 2000 s of three axes: 1 % at 1 s (standard error).
  for (const std::size_t n : {1u, 20u, 200u}) {
    const double root_s = std::sqrt(static_cast<double>(n) / 200.0);
    EXPECT_NEAR(allan_deviation(e.gyro, n) * root_s / 3e-4, 1.0, 0.05) << n;
    EXPECT_NEAR(allan_deviation(e.accelerometer, n) * root_s / 2e-3, 1.0, 0.05) << n;
  }
}

TEST(Imu, BiasWalksAtItsRate) {
  ImuOptions options = ideal(100.0);
  options.gyro_bias_walk_radps2_per_sqrt_hz = 4e-5;
  options.accelerometer_bias_walk_mps3_per_sqrt_hz = 3e-4;
  const Errors e = errors(options, 3000.0);
  // A random walk: walk * sqrt(averaging time / 3), for times of many samples.
  for (const std::size_t n : {100u, 300u}) {
    const double root = std::sqrt(static_cast<double>(n) / 100.0 / 3.0);
    EXPECT_NEAR(allan_deviation(e.gyro, n) / (4e-5 * root), 1.0, 0.05) << n;
    EXPECT_NEAR(allan_deviation(e.accelerometer, n) / (3e-4 * root), 1.0, 0.05) << n;
  }
}

TEST(Imu, StartsWithABiasThatDependsOnTheSeed) {
  ImuOptions options = ideal(100.0);
  options.gyro_bias_radps = 0.01;
  std::vector<double> biases;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const auto samples = simulate_imu(still(0.1), options, seed);
    for (const double v : samples.front().angular_rate_radps) biases.push_back(v);
    EXPECT_EQ(samples.front().angular_rate_radps, samples.back().angular_rate_radps);
  }
  EXPECT_NEAR(rms(biases), 0.01, 5e-4) << "1500 draws: 2 % standard error";
}

TEST(Imu, SameForAnyNumberOfThreads) {
  const PoseSpline path = walk();
  const auto run = [&](int threads) {
    const ExecutionScope limit({.threads = threads});
    return simulate_imu(path, ImuOptions{}, 5);
  };
  const auto one = run(1), four = run(4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].angular_rate_radps, four[i].angular_rate_radps);
    ASSERT_EQ(one[i].specific_force_mps2, four[i].specific_force_mps2);
  }
}

TEST(Imu, RefusesOptionsOutOfRange) {
  ImuOptions options;
  options.rate_hz = 0.0;
  EXPECT_THROW(simulate_imu(walk(), options, 1), UsageError);
  options.rate_hz = 100.0;
  options.gyro_bias_radps = std::nan("");
  EXPECT_THROW(simulate_imu(walk(), options, 1), UsageError);
}

}  // namespace imu_test
}  // namespace cmap
