#pragma once

#include <string>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/io/trajectory_file.hpp"

namespace cmap {

/// Turns times into seconds: by `units_per_s`, or, where that is 0, by their size: since 1970, 1e9 seconds have passed,
/// or 1e12 milli-, 1e15 micro- or 1e18 nanoseconds. What the numbers alone tell is said, as is a step that is no time
/// between two poses. Returns the units a second that were taken.
double times_to_seconds(Trajectory& poses, double units_per_s, const std::string& name, std::vector<Warning>& warnings);

/// Warns of poses exactly at 0 0 0 without rotation between others, in the file's order: what programs write where
/// tracking was lost. Those before the first other pose are a start, and one alone may be a return.
void warn_of_zero_poses(const Trajectory& poses, const std::string& name, std::vector<Warning>& warnings);

/// Sorts poses by time and leaves out all but the first of each time, with warnings. What is left out is returned, by
/// time, else in the file's order.
Trajectory put_in_order(Trajectory& poses, const std::string& name, std::vector<Warning>& warnings);

}  // namespace cmap
