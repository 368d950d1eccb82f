#include "cmap/align/pose_pairs.hpp"

#include <algorithm>
#include <limits>

namespace cmap {
namespace {

/// Stamps are written to the microsecond; an offset that was found has rounding of its own.
constexpr double kSameTime_s = 1e-6;

/// Index of the pose nearest in time, as pair_nearest() has it; none farther than max_difference_s.
std::optional<std::size_t> nearest_in_time(const Trajectory& trajectory, double time_s, double max_difference_s) {
  if (trajectory.empty()) return std::nullopt;
  const auto later = std::upper_bound(trajectory.begin(), trajectory.end(), time_s,
                                      [](double t, const StampedPose& pose) { return t < pose.time_s; });
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double after_s = later == trajectory.end() ? kNone : later->time_s - time_s;
  const double before_s = later == trajectory.begin() ? kNone : time_s - (later - 1)->time_s;
  if (!(std::min(after_s, before_s) <= max_difference_s)) return std::nullopt;
  const auto index = static_cast<std::size_t>(later - trajectory.begin());
  return after_s < before_s ? index : index - 1;
}

}  // namespace

std::optional<StampedPose> pose_at(const Trajectory& trajectory, double time_s, double max_gap_s) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time_s,
                                      [](const StampedPose& pose, double t) { return pose.time_s < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->time_s == time_s) return *after;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  const double gap_s = after->time_s - before.time_s;
  if (gap_s > max_gap_s) return std::nullopt;
  const double share = (time_s - before.time_s) / gap_s;
  return StampedPose{time_s, before.position + share * (after->position - before.position),
                     before.rotation.slerp(share, after->rotation)};
}

std::vector<PosePair> pair_in_time(const Trajectory& source, const Trajectory& target, double max_gap_s) {
  const Trajectory there = first_of_each_time(target);
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : first_of_each_time(source)) {
    if (const auto found = pose_at(there, pose.time_s, max_gap_s)) {
      pairs.push_back({pose, *found});
    } else if (const auto same = nearest_in_time(there, pose.time_s, kSameTime_s)) {
      pairs.push_back({pose, there[*same]});
    }
  }
  return pairs;
}

std::vector<PosePair> pair_nearest(const Trajectory& source, const Trajectory& target, double max_difference_s) {
  const bool target_is_shorter = target.size() < source.size();
  const Trajectory& shorter = target_is_shorter ? target : source;
  const Trajectory& longer = target_is_shorter ? source : target;
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : shorter) {
    const auto nearest = nearest_in_time(longer, pose.time_s, max_difference_s);
    if (!nearest) continue;
    const StampedPose& other = longer[*nearest];
    pairs.push_back(target_is_shorter ? PosePair{other, pose} : PosePair{pose, other});
  }
  return pairs;
}

Trajectory first_of_each_time(const Trajectory& trajectory) {
  Trajectory firsts;
  for (const StampedPose& pose : trajectory) {
    if (firsts.empty() || pose.time_s != firsts.back().time_s) firsts.push_back(pose);
  }
  return firsts;
}

Trajectory shifted_in_time(Trajectory trajectory, double offset_s) {
  for (StampedPose& pose : trajectory) pose.time_s += offset_s;
  return trajectory;
}

}  // namespace cmap
