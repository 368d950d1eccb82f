#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/geometry/trajectory.hpp"

namespace cmap {

/// Why no frame has a pose at its time, for people: both spans, the gap between poses that is allowed, and what may be
/// wrong with the times.
std::string no_common_time(std::span<const double> frame_times_s, const Trajectory& poses, double max_gap_s);

/// Finds sessions whose times are a copy of another's, as a table of frames under two names is.
class SeenTimes {
 public:
  /// What is to be said of a session; none: no earlier one has these very times.
  std::optional<std::string> add(const std::string& session, const std::vector<double>& times_s);

 private:
  std::map<std::vector<double>, std::string> sessions_;
};

}  // namespace cmap
