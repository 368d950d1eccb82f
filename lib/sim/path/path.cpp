#include "cmap/sim/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "capture/option_descriptions.hpp"
#include "cmap/sim/random_stream.hpp"
#include "sensors/degrees.hpp"

namespace cmap {
namespace {

/// 0 before 0, 1 after 1, without a jump of the first two derivatives.
double eased(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

/// Integral of eased from 0 to x in [0,1].
double eased_integral(double x) { return x * x * x * x * (2.5 + x * (-3.0 + x)); }

/// A polyline by its length, going straight on before its start and after its end.
class LengthRoute {
 public:
  explicit LengthRoute(const Route& route) {
    if (route.empty()) throw std::invalid_argument("a route without a corner");
    corners_.push_back(route.front());
    lengths_.push_back(0.0);
    for (const Eigen::Vector3d& corner : route) {
      const double step = (corner - corners_.back()).norm();
      if (step == 0.0) continue;
      lengths_.push_back(lengths_.back() + step);
      corners_.push_back(corner);
    }
  }

  double length() const { return lengths_.back(); }

  Eigen::Vector3d at(double s) const {
    if (corners_.size() == 1) return corners_.front();
    const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, s);
    const std::size_t i = static_cast<std::size_t>(after - lengths_.begin());
    const double u = (s - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return corners_[i - 1] + u * (corners_[i] - corners_[i - 1]);
  }

  /// Mean of the places within `reach` with weights falling linearly to 0: corners become smooth curves.
  Eigen::Vector3d smooth_at(double s, double reach) const {
    constexpr int kNodes = 32;  // per side: the curve's own wrinkles are reach / 32 long and below the knots
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (int i = -kNodes; i <= kNodes; ++i) {
      const double weight = 1.0 - std::abs(i) / (kNodes + 1.0);
      sum += weight * at(s + reach * i / kNodes);
      weights += weight;
    }
    return sum / weights;
  }

 private:
  std::vector<Eigen::Vector3d> corners_;
  std::vector<double> lengths_;
};

/// Way gone at a time after the start of the motion.
struct TimeLaw {
  double length_m, ramp_s, speed_mps;

  TimeLaw(double length, const PathOptions& o) : length_m(length), ramp_s(o.ramp_s), speed_mps(o.speed_mps) {
    // Both ramps together go speed * ramp_s.
    if (speed_mps * ramp_s > length_m) speed_mps = length_m / ramp_s;
  }
  double moving_s() const { return length_m > 0.0 ? ramp_s + length_m / speed_mps : 0.0; }
  double way(double t) const {
    if (t <= 0.0) return 0.0;
    if (t >= moving_s()) return length_m;
    if (t < ramp_s) return speed_mps * ramp_s * eased_integral(t / ramp_s);
    if (t > moving_s() - ramp_s) {
      return length_m - speed_mps * ramp_s * eased_integral((moving_s() - t) / ramp_s);
    }
    return speed_mps * (t - 0.5 * ramp_s);
  }
};

/// Six independent swings of unit standard deviation: each three sines whose frequencies share no short period.
class Sway {
 public:
  Sway(double frequency_hz, std::uint64_t seed) {
    RandomStream random(seed, kRandomSway);
    constexpr std::array<double, 3> kRatio{0.618, 1.0, 1.414};
    for (auto& axis : waves_) {
      for (std::size_t i = 0; i < axis.size(); ++i) {
        axis[i] = {2.0 * std::numbers::pi * frequency_hz * kRatio[i] * random.uniform(0.9, 1.1),
                   random.uniform(0.0, 2.0 * std::numbers::pi)};
      }
    }
  }
  Eigen::Matrix<double, 6, 1> at(double t) const {
    Eigen::Matrix<double, 6, 1> value;
    for (std::size_t axis = 0; axis < waves_.size(); ++axis) {
      double sum = 0.0;
      for (const Wave& wave : waves_[axis]) sum += std::sin(wave.rate * t + wave.phase);
      value[static_cast<int>(axis)] = sum * std::sqrt(2.0 / 3.0);  // a sine has the variance 1/2
    }
    return value;
  }

 private:
  struct Wave {
    double rate, phase;
  };
  std::array<std::array<Wave, 3>, 6> waves_;
};

/// Direction of the smoothed route in the plane; that of the next stretch that has one.
double heading_at(const LengthRoute& route, double s, double reach) {
  const double half = std::max(0.05, 0.1 * reach);
  const Eigen::Vector3d way = route.smooth_at(s + half, reach) - route.smooth_at(s - half, reach);
  return std::atan2(way.y(), way.x());
}

Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, double yaw, double pitch, double roll) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = position;
  T.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

void check_path(const PathOptions& options) {
  check_fields(options, "path");
  if (options.sway_frequency_hz * options.knot_spacing_s > 0.25) {
    throw UsageError("path: knot_spacing_s must be below a quarter of the sway's period");
  }
}

}  // namespace

Route straight_route(const Eigen::Vector3d& start, double heading_deg, double length_m) {
  const double heading = heading_deg * kRadPerDeg;
  return {start, start + length_m * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0)};
}

Route block_route(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z_m, double overlap_m) {
  Route route{{min.x(), min.y(), z_m}, {max.x(), min.y(), z_m}, {max.x(), max.y(), z_m}, {min.x(), max.y(), z_m}};
  route.push_back(route.front());
  if (overlap_m > 0.0) route.emplace_back(std::min(max.x(), min.x() + overlap_m), min.y(), z_m);
  return route;
}

Route survey_route(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z_m, double line_distance_m) {
  if (!(line_distance_m > 0.0)) throw std::invalid_argument("survey lines need a distance above 0");
  Route route;
  bool out = true;
  for (double y = min.y(); y <= max.y() + 1e-9 * line_distance_m; y += line_distance_m, out = !out) {
    route.emplace_back(out ? min.x() : max.x(), y, z_m);
    route.emplace_back(out ? max.x() : min.x(), y, z_m);
  }
  return route;
}

Route draped_route(const Route& route, const GroundHeight& ground, double height_m, double step_m) {
  if (!(step_m > 0.0)) throw std::invalid_argument("a draped route needs a step above 0");
  Route draped;
  const auto add = [&](const Eigen::Vector3d& place) {
    draped.emplace_back(place.x(), place.y(), ground(place.x(), place.y()) + height_m);
  };
  for (std::size_t i = 0; i < route.size(); ++i) {
    if (i > 0) {
      const Eigen::Vector3d way = route[i] - route[i - 1];
      const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / step_m)));
      for (int part = 1; part < parts; ++part) add(route[i - 1] + way * (static_cast<double>(part) / parts));
    }
    add(route[i]);
  }
  return draped;
}

PoseSpline make_path(const Route& route, const PathOptions& o, std::uint64_t seed) {
  check_path(o);
  const LengthRoute way(route);
  const TimeLaw law(way.length(), o);
  const Sway sway(o.sway_frequency_hz, seed);
  // The two controls after a moment still act on it.
  const double moves_at = o.rest_s + 2.0 * o.knot_spacing_s;
  const double duration = moves_at + law.moving_s() + o.hold_s + 2.0 * o.knot_spacing_s;
  const auto knots = static_cast<std::size_t>(std::ceil(duration / o.knot_spacing_s)) + 3;
  std::vector<Eigen::Isometry3d> controls;
  for (std::size_t i = 0; i < knots; ++i) {
    const double t = o.knot_spacing_s * (static_cast<double>(i) - 1.0) - moves_at;
    const double s = law.way(t);
    const Eigen::Matrix<double, 6, 1> swing = eased(t / o.ramp_s) * sway.at(t);
    const double heading = o.turn_with_route ? heading_at(way, s, o.corner_m) : 0.0;
    controls.push_back(pose_of(way.smooth_at(s, o.corner_m) + o.sway_position_m * swing.head<3>(),
                               heading + kRadPerDeg * (o.heading_offset_deg + o.sway_yaw_deg * swing[3]),
                               kRadPerDeg * o.sway_pitch_deg * swing[4], kRadPerDeg * o.sway_roll_deg * swing[5]));
  }
  return {o.start_time_s, o.knot_spacing_s, controls};
}

}  // namespace cmap
