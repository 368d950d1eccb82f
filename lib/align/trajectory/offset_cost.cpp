#include "trajectory/offset_cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "trajectory/robust_centers.hpp"

namespace cmap {
namespace {

constexpr std::size_t kMostAnchors = 2000;
constexpr double kLeastOverlap = 0.3;
constexpr std::size_t kFewestOfAnchors = 8;

Trajectory thinned(const Trajectory& trajectory) {
  const std::size_t step = (trajectory.size() + kMostAnchors - 1) / kMostAnchors;
  Trajectory kept;
  for (std::size_t i = 0; i < trajectory.size(); i += step) kept.push_back(trajectory[i]);
  return kept;
}

bool source_is_sparser(const Trajectory& source, const Trajectory& target) {
  return median_step_s(source) >= median_step_s(target);
}

}  // namespace

OffsetCost::OffsetCost(const Trajectory& source, const Trajectory& target, double max_gap_s)
    : anchors_are_source_(source_is_sparser(source, target)),
      anchors_(thinned(anchors_are_source_ ? source : target)),
      least_pairs_(
          std::max(kFewestOfAnchors, static_cast<std::size_t>(kLeastOverlap * static_cast<double>(anchors_.size())))),
      path_(anchors_are_source_ ? target : source, max_gap_s) {}

std::optional<PosePair> OffsetCost::pair_of(const StampedPose& anchor, double offset_s) const {
  const auto position = path_.position(anchor.time_s + (anchors_are_source_ ? offset_s : -offset_s));
  if (!position) return std::nullopt;
  const StampedPose other{anchor.time_s, *position, Eigen::Quaterniond::Identity()};
  return anchors_are_source_ ? PosePair{anchor, other} : PosePair{other, anchor};
}

std::vector<PosePair> OffsetCost::pairs(double offset_s) const {
  std::vector<PosePair> found;
  for (const StampedPose& anchor : anchors_) {
    if (const auto pair = pair_of(anchor, offset_s)) found.push_back(*pair);
  }
  return found;
}

double OffsetCost::sq_error_m2(double offset_s) const {
  constexpr double kNoFit = std::numeric_limits<double>::infinity();
  const std::vector<PosePair> found = pairs(offset_s);
  if (found.size() < least_pairs_) return kNoFit;
  const PairMoments moments = center_moments(found);
  try {
    const Similarity T = fit_similarity(moments, ScaleModel::free());
    return std::max(0.0, similarity_cost(moments, ScaleModel::free(), T)) / moments.weight;
  } catch (const UnsupportedError&) {
    return kNoFit;
  }
}

double OffsetCost::refined(double offset_s, double reach_s) const {
  constexpr int kSteps = 20;  // to each side
  constexpr double kGolden = 0.6180339887498949, kEnd_s = 1e-6;
  double best_s = offset_s, least = sq_error_m2(offset_s);
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double at_s = offset_s + reach_s * i / kSteps;
    const double found = sq_error_m2(at_s);
    if (found < least) least = found, best_s = at_s;
  }
  double low_s = best_s - reach_s / kSteps, high_s = best_s + reach_s / kSteps;
  while (high_s - low_s > kEnd_s) {
    const double left_s = high_s - kGolden * (high_s - low_s), right_s = low_s + kGolden * (high_s - low_s);
    if (sq_error_m2(left_s) < sq_error_m2(right_s)) {
      high_s = right_s;
    } else {
      low_s = left_s;
    }
  }
  return 0.5 * (low_s + high_s);
}

bool OffsetCost::keep_what_fits(double offset_s, double times_median) {
  Trajectory paired;
  std::vector<PosePair> found;
  for (const StampedPose& anchor : anchors_) {
    if (const auto pair = pair_of(anchor, offset_s)) paired.push_back(anchor), found.push_back(*pair);
  }
  if (found.size() < least_pairs_) return false;
  std::vector<double> distances;
  try {
    distances = center_distances(found, fit_most_centers(found, ScaleModel::free()).T);
  } catch (const UnsupportedError&) {
    return false;  // in a line
  }
  std::vector<double> ranked = distances;
  const double most_m = times_median * upper_median(ranked);
  anchors_.clear();
  for (std::size_t i = 0; i < paired.size(); ++i) {
    if (distances[i] <= most_m) anchors_.push_back(paired[i]);
  }
  return true;
}

std::vector<OffsetCost::Slip> OffsetCost::slips(double offset_s, const Similarity& T, double reach_s) const {
  std::vector<Slip> found;
  for (const StampedPose& anchor : anchors_) {
    const auto pair = pair_of(anchor, offset_s);
    const double time_s = anchor.time_s + (anchors_are_source_ ? offset_s : -offset_s);
    const auto before = path_.position(time_s - reach_s), after = path_.position(time_s + reach_s);
    if (!pair || !before || !after) continue;
    const Eigen::Vector3d velocity = (*after - *before) / (2.0 * reach_s);
    found.push_back({pair->target.position, anchors_are_source_ ? velocity : Eigen::Vector3d(T.linear() * velocity)});
  }
  return found;
}

}  // namespace cmap
