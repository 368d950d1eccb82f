#include "cmap/sim/pose_spline.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cmap {
namespace {

Eigen::Quaterniond exponential(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  // sin(angle / 2) / angle; its series where the quotient would lose digits.
  const double s = angle > 1e-4 ? std::sin(0.5 * angle) / angle : 0.5 - angle * angle / 48.0;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = s * rotation_vector;
  return q;
}

Eigen::Vector3d logarithm(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double n = q.vec().norm();
  const double scale = n > 1e-9 ? 2.0 * std::atan2(n, q.w()) / n : 2.0;
  return scale * q.vec();
}

/// Weights of the three steps of a cumulative cubic B-spline, and their derivatives by u (Kim, Kim, Shin, eq. 4).
struct CumulativeWeights {
  double value[3], first[3], second[3];
};

CumulativeWeights cumulative_weights(double u) {
  const double u2 = u * u, u3 = u2 * u;
  return {{(5.0 + 3.0 * u - 3.0 * u2 + u3) / 6.0, (1.0 + 3.0 * u + 3.0 * u2 - 2.0 * u3) / 6.0, u3 / 6.0},
          {(1.0 - 2.0 * u + u2) / 2.0, (1.0 + 2.0 * u - 2.0 * u2) / 2.0, u2 / 2.0},
          {u - 1.0, 1.0 - 2.0 * u, u}};
}

}  // namespace

PoseSpline::PoseSpline(double start_s, double spacing_s, const std::vector<Eigen::Isometry3d>& controls)
    : start_s_(start_s), spacing_s_(spacing_s) {
  if (controls.size() < 4) throw std::invalid_argument("a cubic spline needs 4 control poses");
  if (!(spacing_s > 0.0)) throw std::invalid_argument("the spacing of a spline must be above 0");
  for (const Eigen::Isometry3d& T : controls) {
    positions_.push_back(T.translation());
    rotations_.push_back(Eigen::Quaterniond(T.rotation()).normalized());
  }
  for (std::size_t i = 0; i + 1 < rotations_.size(); ++i) {
    steps_.push_back(logarithm(rotations_[i].conjugate() * rotations_[i + 1]));
    if (steps_.back().norm() > 0.999 * std::numbers::pi) {
      throw std::invalid_argument(fmt::format("control poses {} and {} are half a turn apart", i, i + 1));
    }
  }
}

PoseSpline::Place PoseSpline::place(double time_s) const {
  const double x = (time_s - start_s_) / spacing_s_;
  const std::size_t segments = rotations_.size() - 3;
  // Times computed as start + i step may miss the ends by a rounding.
  constexpr double kRounding = 1e-6;
  if (!(x >= -kRounding && x <= static_cast<double>(segments) + kRounding)) {
    throw std::out_of_range(fmt::format("time {} s is outside of the path, {} to {} s", time_s, start_s_, end_s()));
  }
  const std::size_t first = x <= 0.0 ? 0 : std::min(static_cast<std::size_t>(x), segments - 1);
  return {first, x - static_cast<double>(first)};
}

Eigen::Isometry3d PoseSpline::pose(double time_s) const {
  const auto [i, u] = place(time_s);
  const CumulativeWeights w = cumulative_weights(u);
  Eigen::Vector3d position = positions_[i];
  Eigen::Quaterniond rotation = rotations_[i];
  for (std::size_t j = 0; j < 3; ++j) {
    position += w.value[j] * (positions_[i + j + 1] - positions_[i + j]);
    rotation = rotation * exponential(w.value[j] * steps_[i + j]);
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = position;
  return T;
}

Motion PoseSpline::motion(double time_s) const {
  const auto [i, u] = place(time_s);
  const CumulativeWeights w = cumulative_weights(u);
  const double by_time = 1.0 / spacing_s_;
  Motion m;
  m.T_world_body = pose(time_s);
  for (std::size_t j = 0; j < 3; ++j) {
    const double rate = w.first[j] * by_time, acceleration = w.second[j] * by_time * by_time;
    const Eigen::Vector3d step = positions_[i + j + 1] - positions_[i + j];
    m.velocity_mps += rate * step;
    m.acceleration_mps2 += acceleration * step;

    const Eigen::Vector3d& turn = steps_[i + j];
    const Eigen::Quaterniond back = exponential(-w.value[j] * turn);
    m.angular_rate_radps = back * m.angular_rate_radps + rate * turn;
    m.angular_acceleration_radps2 =
        back * m.angular_acceleration_radps2 + rate * m.angular_rate_radps.cross(turn) + acceleration * turn;
  }
  return m;
}

}  // namespace cmap
