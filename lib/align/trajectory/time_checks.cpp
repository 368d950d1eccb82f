#include "trajectory/time_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// Where one trajectory lasts about 1e3, 1e6 or 1e9 times as long as the other, its times are probably no seconds.
std::string unit_hint(const Trajectory& source, const Trajectory& target) {
  constexpr std::array<std::pair<double, const char*>, 3> kUnits{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const double source_s = duration_s(source), target_s = duration_s(target);
  if (!(source_s > 0.0 && target_s > 0.0)) return {};
  const bool of_source = source_s > target_s;
  const double ratio = of_source ? source_s / target_s : target_s / source_s;
  for (const auto& [factor, name] : kUnits) {
    if (ratio < factor / 4.0 || ratio > factor * 4.0) continue;
    return fmt::format("; are those of the {} {}?", of_source ? "source" : "target", name);
  }
  return "; --time-offset estimate finds the offset between two clocks";
}

bool within_time_of(const Trajectory& trajectory, double time_s) {
  return time_s >= trajectory.front().time_s && time_s <= trajectory.back().time_s;
}

/// The poses of the target around the source's that have no pair.
struct Gaps {
  std::size_t n_poses = 0;  ///< of the source, within the target's time
  double shortest_s = 0.0, longest_s = 0.0;
};

Gaps gaps_of(const Trajectory& source, const Trajectory& target, double max_gap_s) {
  Gaps gaps;
  for (const StampedPose& pose : source) {
    if (!within_time_of(target, pose.time_s) || pose_at(target, pose.time_s, max_gap_s)) continue;
    const auto after = std::ranges::lower_bound(target, pose.time_s, {}, &StampedPose::time_s);
    const double gap_s = after->time_s - (after - 1)->time_s;
    gaps.shortest_s = gaps.n_poses == 0 ? gap_s : std::min(gaps.shortest_s, gap_s);
    gaps.longest_s = std::max(gaps.longest_s, gap_s);
    ++gaps.n_poses;
  }
  return gaps;
}

std::string times_of(const Trajectory& source, const Trajectory& target) {
  return fmt::format("the source is from {} to {} s, the target from {} to {} s", source.front().time_s,
                     source.back().time_s, target.front().time_s, target.back().time_s);
}

}  // namespace

void require_pairs(const Trajectory& source, const Trajectory& target, std::size_t n_pairs,
                   const TrajectoryOptions& options) {
  if (n_pairs > 0) return;
  const bool share_time =
      source.front().time_s <= target.back().time_s && target.front().time_s <= source.back().time_s;
  if (share_time && options.pairing == TimePairing::kNearest) {
    throw UnsupportedError(
        fmt::format("no two poses are within {:g} s of each other: {}; --max-difference takes larger ones, --pairing "
                    "interpolated the poses between",
                    options.max_difference_s, times_of(source, target)));
  }
  const Gaps gaps = gaps_of(source, target, options.max_gap_s);
  if (gaps.n_poses > 0) {
    throw UnsupportedError(
        fmt::format("no pose of the source lies between two of the target that are at most {:g} s apart: those around "
                    "are {:.3g} to {:.3g} s apart; --max-gap takes longer gaps",
                    options.max_gap_s, gaps.shortest_s, gaps.longest_s));
  }
  throw UnsupportedError(
      fmt::format("the times do not meet: {}{}", times_of(source, target), unit_hint(source, target)));
}

void warn_of_gaps(const Trajectory& source, const Trajectory& target, double max_gap_s,
                  std::vector<std::string>& warnings) {
  const Gaps gaps = gaps_of(source, target, max_gap_s);
  if (gaps.n_poses == 0) return;
  warnings.push_back(
      fmt::format("{} of {} poses of the source have no pair: the target's poses around them are up to {:.3g} s apart, "
                  "more than --max-gap, {:g} s",
                  gaps.n_poses, source.size(), gaps.longest_s, max_gap_s));
}

}  // namespace cmap
