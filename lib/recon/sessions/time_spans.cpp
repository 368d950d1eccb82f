#include "sessions/time_spans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

/// The least distance in time between two poses around a frame; infinite where no frame is between poses.
double least_gap_s(std::span<const double> times_s, const Trajectory& poses) {
  double gap_s = std::numeric_limits<double>::infinity();
  for (const double time_s : times_s) {
    const auto after = std::ranges::lower_bound(poses, time_s, {}, &StampedPose::time_s);
    if (after == poses.begin() || after == poses.end()) continue;
    gap_s = std::min(gap_s, after->time_s - std::prev(after)->time_s);
  }
  return gap_s;
}

/// What a ratio of about a thousand, a million or a billion says.
std::string unit_hint(double frame_s, double pose_s) {
  constexpr std::array<std::pair<double, const char*>, 3> kUnits{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const bool is_frame = std::abs(frame_s) > std::abs(pose_s);
  const double ratio = std::abs(is_frame ? frame_s / pose_s : pose_s / frame_s);
  for (const auto& [factor, name] : kUnits) {
    if (ratio < factor / 4.0 || ratio > factor * 4.0) continue;
    return fmt::format("; are those of the {} {}?", is_frame ? "frames" : "poses", name);
  }
  return "; time_offset.image_s of capture.json tells of another clock";
}

}  // namespace

std::string no_common_time(std::span<const double> frame_times_s, const Trajectory& poses, double max_gap_s) {
  const double first_s = frame_times_s.front(), last_s = frame_times_s.back();
  const std::string spans = fmt::format(
      "no frame has a LiDAR-inertial pose at its time: the frames are from {:.3f} to {:.3f} s, the poses from "
      "{:.3f} to {:.3f} s",
      first_s, last_s, poses.front().time_s, poses.back().time_s);
  const double gap_s = least_gap_s(frame_times_s, poses);
  if (std::isfinite(gap_s)) {
    return fmt::format("{}, {:.3g} s or more apart around the frames; at most {:g} s are allowed (max_gap_s)", spans,
                       gap_s, max_gap_s);
  }
  return fmt::format("{}, with gaps of at most {:g} s allowed between poses (max_gap_s){}", spans, max_gap_s,
                     unit_hint(last_s, poses.back().time_s));
}

std::optional<std::string> SeenTimes::add(const std::string& session, const std::vector<double>& times_s) {
  const auto [place, is_new] = sessions_.try_emplace(times_s, session);
  if (is_new) return std::nullopt;
  return fmt::format("has the very times of {}; is its frames.csv a copy?", place->second);
}

}  // namespace cmap
