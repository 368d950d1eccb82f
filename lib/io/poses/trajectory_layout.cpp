#include "poses/trajectory_layout.hpp"

#include <fmt/format.h>

#include <numeric>

namespace cmap {
namespace {

/// A time, if there is one, before a pose of n values.
TrajectoryLayout in_order(bool with_time, std::size_t n) {
  TrajectoryLayout layout;
  layout.columns = n + (with_time ? 1 : 0);
  if (with_time) layout.time = 0;
  layout.pose.resize(n);
  std::iota(layout.pose.begin(), layout.pose.end(), layout.columns - n);
  return layout;
}

/// EuRoC's state_groundtruth_estimate0/data.csv: time, position, quaternion w x y z, velocity, biases.
TrajectoryLayout euroc() {
  TrajectoryLayout layout = in_order(true, 7);
  layout.columns = 17;
  layout.pose = {1, 2, 3, 5, 6, 7, 4};
  return layout;
}

bool ends_as_matrix(const RowReader& row) {
  const std::size_t n = row.cells().size();
  return row.number(n - 4) == 0.0 && row.number(n - 3) == 0.0 && row.number(n - 2) == 0.0 && row.number(n - 1) == 1.0;
}

constexpr std::string_view kKnownLayouts =
    "a pose is read from 8 numbers, time x y z qx qy qz qw (TUM), from the 12 or 16 of a matrix (KITTI), or from "
    "columns "
    "that a header line names";

}  // namespace

TrajectoryLayout trajectory_layout_by_count(const RowReader& first_row) {
  const LineReader& lines = first_row.lines();
  switch (const std::size_t n = first_row.cells().size()) {
    case 8:
      return in_order(true, 7);
    case 12:
    case 16:
      return in_order(false, n);
    case 13:
      return in_order(true, 12);
    case 17:
      return ends_as_matrix(first_row) ? in_order(true, 16) : euroc();
    case 4:
      lines.fail("4 numbers: a position without orientation, or a matrix over several lines; {}", kKnownLayouts);
    case 7:
      lines.fail("7 numbers: a pose without its time, or angles in place of a quaternion; {}", kKnownLayouts);
    default:
      lines.fail("{} numbers; {}", n, kKnownLayouts);
  }
}

}  // namespace cmap
