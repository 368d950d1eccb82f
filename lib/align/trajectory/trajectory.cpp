#include "cmap/align/trajectory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "cmap/core/error.hpp"
#include "icp/information.hpp"
#include "trajectory/path_judgment.hpp"
#include "trajectory/robust_centers.hpp"
#include "trajectory/time_checks.hpp"

namespace cmap {
namespace {

constexpr std::array<const char*, 3> kFitNames{"trajectory-first-frame", "trajectory-se3", "trajectory-sim3"};

ScaleModel scale_model(TrajectoryFit fit) {
  return fit == TrajectoryFit::kSim3 ? ScaleModel::free() : ScaleModel::rigid();
}

std::vector<PosePair> paired(const Trajectory& source, const Trajectory& target, TimePairing pairing,
                             const TrajectoryOptions& options) {
  return pairing == TimePairing::kNearest ? pair_nearest(source, target, options.max_difference_s)
                                          : pair_in_time(source, target, options.max_gap_s);
}

/// Interpolation takes one pose a time.
std::size_t n_that_may_pair(const Trajectory& source, TimePairing pairing) {
  return pairing == TimePairing::kNearest ? source.size() : first_of_each_time(source).size();
}

Similarity first_frame(const PosePair& pair) {
  Similarity T;
  T.rotation = (pair.target.rotation * pair.source.rotation.conjugate()).toRotationMatrix();
  T.translation = pair.target.position - T.rotation * pair.source.position;
  return T;
}

TrajectoryError trajectory_error(std::span<const PosePair> pairs, TimePairing pairing, TrajectoryFit fit) {
  const Similarity T =
      fit == TrajectoryFit::kFirstFrame ? first_frame(pairs.front()) : fit_centers(pairs, scale_model(fit));
  return {pairing, pairs.size(), center_rmse_m(pairs, T)};
}

/// By the other pairing than the one that was asked for.
std::optional<TrajectoryError> other_error(const Trajectory& source, const Trajectory& target,
                                           const TrajectoryOptions& options) {
  const TimePairing other =
      options.pairing == TimePairing::kNearest ? TimePairing::kInterpolated : TimePairing::kNearest;
  const std::vector<PosePair> pairs = paired(source, target, other, options);
  if (pairs.empty()) return std::nullopt;
  try {
    return trajectory_error(pairs, other, options.fit);
  } catch (const UnsupportedError&) {
    return std::nullopt;  // too few, or in a line
  }
}

/// Information of positions: every pair says where its point is.
void add_observability(std::span<const PosePair> pairs, const Similarity& T, bool with_scale, Alignment& result) {
  const PairMoments moments = center_moments(pairs);
  NormalEquations information;
  for (const PosePair& pair : pairs) {
    information.add(T * pair.source.position - T * moments.mean_p, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
                    1.0);
  }
  const double lever_m = T.scale * std::sqrt(moments.scatter_p.trace() / moments.weight);
  tell_observability(observability(information.H, with_scale, lever_m), result);
}

/// Leaves out the pairs that do not fit, and says so.
std::vector<PosePair> leave_out_misfits(std::span<const PosePair> pairs, const RobustCenters& found,
                                        TrajectoryAlignment& result) {
  constexpr std::size_t kMostNamed = 10;
  std::vector<PosePair> fitting;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (found.fits[i] != 0) {
      fitting.push_back(pairs[i]);
    } else {
      result.misfit_times_s.push_back(pairs[i].source.time_s);
    }
  }
  const std::vector<double>& times_s = result.misfit_times_s;
  if (times_s.empty()) return fitting;
  std::vector<std::string> named;
  for (const double t : times_s) {
    if (named.size() < kMostNamed) named.push_back(fmt::format("{:.3f}", t));
  }
  result.warnings.push_back(fmt::format(
      "{} of {} poses {} not fit and {} left out, at {} s{}", times_s.size(), pairs.size(),
      times_s.size() == 1 ? "does" : "do", times_s.size() == 1 ? "is" : "are", fmt::join(named, ", "),
      times_s.size() > kMostNamed ? fmt::format(" and {} more", times_s.size() - kMostNamed) : std::string()));
  return fitting;
}

/// T, and the pairs that it is from.
std::vector<PosePair> fit_pairs(const std::vector<PosePair>& pairs, TrajectoryFit fit, Similarity& T,
                                TrajectoryAlignment& result) {
  if (fit == TrajectoryFit::kFirstFrame) {
    T = first_frame(pairs.front());
    result.condition = 1.0;  // a pose is complete
    return pairs;
  }
  const RobustCenters found = fit_most_centers(pairs, scale_model(fit));
  T = found.T;
  std::vector<PosePair> fitting = leave_out_misfits(pairs, found, result);
  add_observability(fitting, T, fit == TrajectoryFit::kSim3, result);
  return fitting;
}

/// With the times as they are.
TrajectoryAlignment align_at(const Trajectory& source, const Trajectory& target, const TrajectoryOptions& options) {
  const std::vector<PosePair> pairs = paired(source, target, options.pairing, options);
  require_pairs(source, target, pairs.size(), options);
  TrajectoryAlignment result;
  Similarity T;
  const std::vector<PosePair> fitting = fit_pairs(pairs, options.fit, T, result);
  result.method = kFitNames[static_cast<std::size_t>(options.fit)];
  result.T_dst_src = T.matrix();
  result.scale = T.scale;
  result.n_source = n_that_may_pair(source, options.pairing);
  result.n_target = target.size();
  result.n_matches = fitting.size();
  result.overlap = std::min(1.0, static_cast<double>(pairs.size()) / static_cast<double>(result.n_source));
  result.rmse_m = center_rmse_m(fitting, T);
  result.converged = true;
  result.errors.push_back(trajectory_error(pairs, options.pairing, options.fit));
  if (const auto other = other_error(source, target, options)) result.errors.push_back(*other);
  if (options.pairing == TimePairing::kInterpolated) warn_of_gaps(source, target, options.max_gap_s, result.warnings);
  result.judgment = judge_paths(fitting, T, options.fit);
  return result;
}

/// An offset that was found and not asked for is told, not taken.
void tell_other_offset(const TimeOffsetSearch& search, TrajectoryAlignment& result) {
  constexpr double kGain = 0.7, kErrors = 3.0, kShortest_s = 1e-3;
  if (!search.found || result.judgment.verdict == Verdict::kMirrored) return;
  const TimeOffset& offset = *search.found;
  const double apart_s = std::abs(offset.offset_s - result.time_offset_s);
  if (apart_s < std::max(kErrors * offset.standard_error_s, kShortest_s)) return;
  if (!(offset.rmse_m < kGain * result.rmse_m)) return;
  result.found_time_offset = offset;
  const std::string advice = fmt::format("--time-offset {:.4f} would leave an RMSE of {:.3g} m in place of {:.3g} m",
                                         offset.offset_s, offset.rmse_m, result.rmse_m);
  result.warnings.push_back(fmt::format("the clocks differ: {} (standard error {:.2g} s); it is not applied", advice,
                                        offset.standard_error_s));
  if (!is_trusted(result.judgment.verdict)) result.judgment.help = "the clocks differ: " + advice;
}

}  // namespace

Similarity fit_centers(std::span<const PosePair> pairs, const ScaleModel& model) {
  return fit_similarity(center_moments(pairs), model);
}

const EnumNames<TrajectoryFit>& trajectory_fit_names() {
  static const EnumNames<TrajectoryFit> names{
      {TrajectoryFit::kFirstFrame, "first-frame"}, {TrajectoryFit::kSe3, "se3"}, {TrajectoryFit::kSim3, "sim3"}};
  return names;
}

const EnumNames<TimePairing>& time_pairing_names() {
  static const EnumNames<TimePairing> names{{TimePairing::kInterpolated, "interpolated"},
                                            {TimePairing::kNearest, "nearest"}};
  return names;
}

TrajectoryAlignment align_trajectories(const Trajectory& source, const Trajectory& target,
                                       const TrajectoryOptions& options) {
  if (source.empty() || target.empty()) throw UnsupportedError("a trajectory without poses cannot be aligned");
  if (!options.find_time_offset) {
    TrajectoryAlignment found = align_at(shifted_in_time(source, options.time_offset_s), target, options);
    found.time_offset_s = options.time_offset_s;
    tell_other_offset(find_time_offset(source, target), found);
    return found;
  }
  const TimeOffsetSearch search = find_time_offset(source, target);
  if (!search.found) throw UnsupportedError("the offset between the clocks is not determined: " + search.reason);
  TrajectoryAlignment found = align_at(shifted_in_time(source, search.found->offset_s), target, options);
  found.time_offset_s = search.found->offset_s;
  found.found_time_offset = search.found;
  return found;
}

}  // namespace cmap
