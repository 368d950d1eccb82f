#include "cmap/align/time_offset.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cmap/align/pose_pairs.hpp"
#include "trajectory/motion_profile.hpp"
#include "trajectory/offset_cost.hpp"
#include "trajectory/residual_correlation.hpp"
#include "trajectory/robust_centers.hpp"

namespace cmap {
namespace {

constexpr double kMostSamples = 4096.0;  // of a profile
constexpr std::size_t kCandidates = 6;
constexpr double kMinOverlap = 0.3;
constexpr double kRoughTimesMedian = 15.0, kTimesMedianKept = 5.0;  // distances beyond do not count
constexpr double kReach_s = 0.5;                                    // of the velocities that the certainty rests on
constexpr double kSlipNoiseMargin = 4.0;  // their squares must exceed what noise makes of them by this
constexpr std::size_t kFewestSlips = 8;
constexpr double kLargestError_s = 0.05;
constexpr double kAsWell = 1.5;
constexpr double kLargestShare = 0.5;
constexpr double kLongestGaps = 5.0;  // median steps
constexpr double kShortestGap_s = 0.15;

double max_gap_s(const Trajectory& trajectory) {
  return std::max(kShortestGap_s, kLongestGaps * median_step_s(trajectory));
}

/// An offset, what fits there, and how well as a share of the positions' spread.
struct Candidate {
  double offset_s = 0.0;
  double rmse_m = 0.0;
  double share = 0.0;
  OffsetCost cost;
};

/// The best offset near one, by what fits at that; none where there is nothing.
std::optional<Candidate> candidate_near(OffsetCost cost, double start_s, double reach_s, double times_median) {
  if (!cost.keep_what_fits(start_s, times_median)) return std::nullopt;
  const double offset_s = cost.refined(start_s, reach_s);
  const double rmse_m = std::sqrt(cost.sq_error_m2(offset_s));
  if (!std::isfinite(rmse_m)) return std::nullopt;
  const PairMoments moments = center_moments(cost.pairs(offset_s));
  return Candidate{offset_s, rmse_m, rmse_m / std::sqrt(moments.sq_q / moments.weight), std::move(cost)};
}

/// The best first; refined by less and less of what does not fit.
std::vector<Candidate> candidates(const Trajectory& source, const Trajectory& target) {
  const double step_s = std::max(
      {median_step_s(source), median_step_s(target), std::max(duration_s(source), duration_s(target)) / kMostSamples});
  const auto profile = [&](const Trajectory& trajectory) {
    return motion_profile(trajectory, step_s, max_gap_s(trajectory));
  };
  const OffsetCost cost(source, target, max_gap_s(median_step_s(source) >= median_step_s(target) ? target : source));
  std::vector<double> starts_s = best_offsets_s(profile(source), profile(target), kMinOverlap, kCandidates);
  starts_s.push_back(0.0);  // as the clocks are
  std::vector<Candidate> found;
  for (const double start_s : starts_s) {
    const auto rough = candidate_near(cost, start_s, 2.0 * step_s, kRoughTimesMedian);
    if (!rough) continue;
    auto candidate = candidate_near(cost, rough->offset_s, step_s, kTimesMedianKept);
    if (candidate) found.push_back(std::move(*candidate));
  }
  std::ranges::stable_sort(found, {}, &Candidate::share);
  return found;
}

/// What a small similarity does to the points, one column each: shift, turn, scale.
Eigen::MatrixXd generators(const std::vector<OffsetCost::Slip>& slips) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const OffsetCost::Slip& slip : slips) center += slip.position / static_cast<double>(slips.size());
  Eigen::MatrixXd columns(3 * std::ssize(slips), 7);
  for (Eigen::Index i = 0; i < std::ssize(slips); ++i) {
    const Eigen::Vector3d x = slips[static_cast<std::size_t>(i)].position - center;
    columns.middleRows<3>(3 * i) << 1, 0, 0, 0.0, x.z(), -x.y(), x.x(),  //
        0, 1, 0, -x.z(), 0.0, x.x(), x.y(),                              //
        0, 0, 1, x.y(), -x.x(), 0.0, x.z();
  }
  return columns;
}

/// Sums of squares of the velocities, and of what no similarity undoes of them.
std::pair<double, double> slip_sums(const std::vector<OffsetCost::Slip>& slips) {
  Eigen::VectorXd velocities(3 * std::ssize(slips));
  for (Eigen::Index i = 0; i < std::ssize(slips); ++i) {
    velocities.segment<3>(3 * i) = slips[static_cast<std::size_t>(i)].velocity;
  }
  const Eigen::MatrixXd columns = generators(slips);
  const Eigen::VectorXd undone = columns * columns.colPivHouseholderQr().solve(velocities);
  return {velocities.squaredNorm(), (velocities - undone).squaredNorm()};
}

/// Squares of the residuals and of their steps.
struct ResidualSums {
  double n = 0.0, sq = 0.0, sq_steps = 0.0;
};

ResidualSums residual_sums(std::span<const PosePair> pairs, const Similarity& T) {
  ResidualSums sums;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d r = T * pair.source.position - pair.target.position;
    if (sums.n > 0.0) sums.sq_steps += (r - before).squaredNorm();
    sums.sq += r.squaredNorm();
    sums.n += 1.0;
    before = r;
  }
  return sums;
}

/// Infinite where the motion does not tell the offset.
double standard_error_s(const OffsetCost& cost, double offset_s) {
  const std::vector<PosePair> pairs = cost.pairs(offset_s);
  const Similarity T = fit_similarity(center_moments(pairs), ScaleModel::free());
  const ResidualSums sums = residual_sums(pairs, T);
  const double variance_m2 = sums.sq / std::max(1.0, 3.0 * sums.n - 8.0);
  const double noise_m2 = sums.sq_steps / (6.0 * sums.n);  // of one coordinate; drift leaves it small
  const std::vector<OffsetCost::Slip> slips = cost.slips(offset_s, T, kReach_s);
  if (slips.size() < kFewestSlips) return std::numeric_limits<double>::infinity();
  const auto n_slips = static_cast<double>(slips.size());
  const double of_noise = kSlipNoiseMargin * n_slips * 3.0 * noise_m2 / (2.0 * kReach_s * kReach_s);
  const auto [all, not_undone] = slip_sums(slips);
  const double told = not_undone - of_noise;
  constexpr double kRoundingOfSlips = 1e-6;  // a cubic through a circle is no circle
  if (!(told > kRoundingOfSlips * all)) return std::numeric_limits<double>::infinity();
  return std::sqrt(variance_m2 / told * alike_in_a_row(pairs, T));
}

/// Why the best candidate is not to be believed; empty where it is.
std::string doubt(const std::vector<Candidate>& found, double error_s) {
  const Candidate& best = found.front();
  if (!(best.share <= kLargestShare)) {
    return fmt::format("at the best, {:.3f} s, the RMSE is {:.3g} m, {:.0f} % of the path's spread", best.offset_s,
                       best.rmse_m, 100.0 * best.share);
  }
  if (!(error_s <= kLargestError_s)) {
    return std::isfinite(error_s)
               ? fmt::format("its standard error is {:.2g} s at {:.3f} s", error_s, best.offset_s)
               : "the path looks the same at other times, as a straight one at constant speed and a circle do";
  }
  for (const Candidate& other : found) {
    const double apart_s = std::abs(other.offset_s - best.offset_s);
    if (apart_s < std::max(10.0 * error_s, 0.02) || other.share > kAsWell * best.share) continue;
    return fmt::format("{:.3f} s and {:.3f} s fit alike, with an RMSE of {:.3g} m and {:.3g} m", best.offset_s,
                       other.offset_s, best.rmse_m, other.rmse_m);
  }
  return {};
}

}  // namespace

TimeOffsetSearch find_time_offset(const Trajectory& all_source, const Trajectory& all_target) {
  constexpr std::size_t kFewestPoses = 8;
  const Trajectory source = first_of_each_time(all_source), target = first_of_each_time(all_target);
  if (source.size() < kFewestPoses || target.size() < kFewestPoses) return {{}, "there are fewer than 8 poses"};
  const std::vector<Candidate> found = candidates(source, target);
  if (found.empty()) return {{}, "no offset gives the paths a common part that has turns"};
  const Candidate& best = found.front();
  const double error_s = standard_error_s(best.cost, best.offset_s);
  std::string reason = doubt(found, error_s);
  if (!reason.empty()) return {{}, std::move(reason)};
  return {TimeOffset{best.offset_s, error_s, best.rmse_m, best.cost.pairs(best.offset_s).size()}, {}};
}

}  // namespace cmap
