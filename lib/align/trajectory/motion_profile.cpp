#include "trajectory/motion_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kShortestReach_s = 0.2;
constexpr double kTimesQuantile = 3.0;
constexpr double kFlat = 1e-3;  // of the mean: a profile that varies by less tells nothing
constexpr double kFewestSamples = 20.0;

/// Angle between two directions; 0 where one is much shorter than the path usually moves.
double turn(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double least_m) {
  if (!(std::min(a.norm(), b.norm()) > least_m)) return 0.0;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void add_sample(const SmoothPath& path, double time_s, double reach_s, double least_m, MotionProfile& profile) {
  const auto before = path.position(time_s - reach_s), here = path.position(time_s),
             after = path.position(time_s + reach_s);
  const auto from = path.rotation(time_s - reach_s), to = path.rotation(time_s + reach_s);
  const bool known = before && here && after && from && to;
  profile.values[0].push_back(known ? (*after - *before).norm() / (2.0 * reach_s) : kUnknown);
  profile.values[1].push_back(known ? from->angularDistance(*to) / (2.0 * reach_s) : kUnknown);
  profile.values[2].push_back(known ? turn(*here - *before, *after - *here, least_m) / reach_s : kUnknown);
}

/// A share of the median displacement over reach_s.
double least_move_m(const Trajectory& trajectory, const SmoothPath& path, double reach_s) {
  constexpr double kShare = 0.2;
  std::vector<double> moves_m;
  for (const StampedPose& pose : trajectory) {
    if (const auto after = path.position(pose.time_s + reach_s)) moves_m.push_back((*after - pose.position).norm());
  }
  return moves_m.empty() ? 0.0 : kShare * upper_median(moves_m);
}

void cut_peaks(std::vector<double>& values) {
  std::vector<double> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](double v) { return !std::isnan(v); });
  if (known.empty()) return;
  const double most = kTimesQuantile * value_at_rank(known, known.size() * 9 / 10);
  for (double& v : values) v = v > most ? most : v;
}

/// Sums over what two profiles share at a lag.
struct Shared {
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
};

/// source[i] against target[i + lag].
Shared shared_at(const std::vector<double>& source, const std::vector<double>& target, std::ptrdiff_t lag) {
  Shared sum;
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -lag);
  const std::ptrdiff_t end = std::min(std::ssize(source), std::ssize(target) - lag);
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double a = source[static_cast<std::size_t>(i)], b = target[static_cast<std::size_t>(i + lag)];
    if (std::isnan(a) || std::isnan(b)) continue;
    sum.n += 1.0;
    sum.a += a, sum.b += b, sum.aa += a * a, sum.bb += b * b, sum.ab += a * b;
  }
  return sum;
}

/// Pearson's correlation; 0 where one of them is flat.
double correlation(const Shared& sum) {
  const double var_a = sum.aa - sum.a * sum.a / sum.n, var_b = sum.bb - sum.b * sum.b / sum.n;
  if (!(var_a > kFlat * kFlat * sum.aa && var_b > kFlat * kFlat * sum.bb)) return 0.0;
  return (sum.ab - sum.a * sum.b / sum.n) / std::sqrt(var_a * var_b);
}

/// How well the profiles agree at a lag: the sum of their correlations, more where more is shared.
double agreement(const MotionProfile& source, const MotionProfile& target, std::ptrdiff_t lag, double min_samples) {
  double sum = 0.0;
  for (std::size_t kind = 0; kind < MotionProfile::kKinds; ++kind) {
    const Shared shared = shared_at(source.values[kind], target.values[kind], lag);
    if (shared.n < min_samples) return kUnknown;
    sum += correlation(shared) * std::sqrt(shared.n);
  }
  return sum;
}

}  // namespace

MotionProfile motion_profile(const Trajectory& trajectory, double step_s, double max_gap_s) {
  MotionProfile profile{trajectory.front().time_s, step_s, {}};
  const SmoothPath path(trajectory, max_gap_s);
  const double reach_s = std::max(step_s, kShortestReach_s);
  const double least_m = least_move_m(trajectory, path, reach_s);
  const auto n = static_cast<std::size_t>((trajectory.back().time_s - profile.begin_s) / step_s) + 1;
  for (std::size_t i = 0; i < n; ++i) {
    add_sample(path, profile.begin_s + static_cast<double>(i) * step_s, reach_s, least_m, profile);
  }
  for (std::vector<double>& values : profile.values) cut_peaks(values);
  return profile;
}

std::vector<double> best_offsets_s(const MotionProfile& source, const MotionProfile& target, double min_overlap,
                                   std::size_t n) {
  const auto shorter = static_cast<double>(std::min(source.size(), target.size()));
  const double min_samples = std::max(kFewestSamples, min_overlap * shorter);
  const std::ptrdiff_t first = 1 - static_cast<std::ptrdiff_t>(source.size());
  std::vector<double> agreements;
  for (std::ptrdiff_t lag = first; lag < static_cast<std::ptrdiff_t>(target.size()); ++lag) {
    agreements.push_back(agreement(source, target, lag, min_samples));
  }
  std::vector<std::pair<double, std::ptrdiff_t>> peaks;
  for (std::size_t i = 0; i < agreements.size(); ++i) {
    const bool is_peak = !(i > 0 && agreements[i - 1] > agreements[i]) &&
                         !(i + 1 < agreements.size() && agreements[i + 1] > agreements[i]);
    if (is_peak && agreements[i] > 0.0) peaks.emplace_back(-agreements[i], first + static_cast<std::ptrdiff_t>(i));
  }
  std::ranges::sort(peaks);
  std::vector<double> offsets_s;
  for (const auto& [negative, lag] : peaks) {
    const double offset_s = target.begin_s - source.begin_s + static_cast<double>(lag) * source.step_s;
    const bool is_new =
        std::ranges::none_of(offsets_s, [&](double other) { return std::abs(other - offset_s) < 2.0 * source.step_s; });
    if (is_new && offsets_s.size() < n) offsets_s.push_back(offset_s);
  }
  return offsets_s;
}

}  // namespace cmap
