#include "cmap/sim/imu.hpp"

#include <cmath>

#include "capture/option_descriptions.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/sim/random_stream.hpp"

namespace cmap {
namespace {

using Six = Eigen::Matrix<double, 6, 1>;  ///< gyroscope, accelerometer

Six six(double gyro, double accelerometer) {
  Six v;
  v << gyro, gyro, gyro, accelerometer, accelerometer, accelerometer;
  return v;
}

Six six_normals(RandomStream random) {
  Six v;
  for (double& x : v) x = random.normal();
  return v;
}

/// Bias of every sample: a sum over the ones before, in order.
std::vector<Six> bias_walk(std::size_t n, const ImuOptions& o, std::uint64_t seed) {
  const Six first = six(o.gyro_bias_radps, o.accelerometer_bias_mps2);
  const Six step =
      six(o.gyro_bias_walk_radps2_per_sqrt_hz, o.accelerometer_bias_walk_mps3_per_sqrt_hz) / std::sqrt(o.rate_hz);
  std::vector<Six> bias(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Six drawn = six_normals(RandomStream(seed, kRandomImuBias, i));
    bias[i] = i == 0 ? Six(first.cwiseProduct(drawn)) : Six(bias[i - 1] + step.cwiseProduct(drawn));
  }
  return bias;
}

}  // namespace

ImuSample ideal_imu_sample(const Motion& m, double time_s, const ImuOptions& o) {
  const Eigen::Vector3d& arm = o.accelerometer_lever_arm_m;
  const Eigen::Vector3d& rate = m.angular_rate_radps;
  const Eigen::Vector3d upward = m.acceleration_mps2 + o.gravity_mps2 * Eigen::Vector3d::UnitZ();
  return {time_s, rate,
          m.T_world_body.linear().transpose() * upward + m.angular_acceleration_radps2.cross(arm) +
              rate.cross(rate.cross(arm))};
}

std::vector<ImuSample> simulate_imu(const PoseSpline& path, const ImuOptions& o, std::uint64_t seed) {
  check_fields(o, "imu");
  // The small part: the last sample where the path ends on one.
  const double intervals = (path.end_s() - path.start_s()) * o.rate_hz + 1e-6;
  std::vector<ImuSample> samples(static_cast<std::size_t>(intervals) + 1);
  const std::vector<Six> bias = bias_walk(samples.size(), o, seed);
  const Six white = six(o.gyro_noise_density_radps_per_sqrt_hz, o.accelerometer_noise_density_mps2_per_sqrt_hz) *
                    std::sqrt(o.rate_hz);
  parallel_chunks(samples.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double t = path.start_s() + static_cast<double>(i) / o.rate_hz;
      samples[i] = ideal_imu_sample(path.motion(t), t, o);
      const Six error = bias[i] + white.cwiseProduct(six_normals(RandomStream(seed, kRandomImuWhite, i)));
      samples[i].angular_rate_radps += error.head<3>();
      samples[i].specific_force_mps2 += error.tail<3>();
    }
  });
  return samples;
}

}  // namespace cmap
