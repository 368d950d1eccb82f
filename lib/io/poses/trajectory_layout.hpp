#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "clouds/row_reader.hpp"

namespace cmap {

/// Which cells of a trajectory's rows are what.
struct TrajectoryLayout {
  std::size_t columns = 0;
  std::optional<std::size_t> time;         ///< none: the rows hold no times
  std::optional<std::size_t> nanoseconds;  ///< to be added to whole seconds
  double units_per_s = 0.0;                ///< of the time, where a header names it; 0: the numbers tell
  bool is_named = false;                   ///< by a header
  std::vector<std::size_t> pose;  ///< 7: x y z qx qy qz qw; 12 or 16: the rows of a matrix, from its first element on
};

/// The layout that a header names ("timestamp [ns], p_x, ..., q_w, ..."); none where it has another number of names
/// than rows have columns, or names no x y z. Throws InputError where it names a position, but no time or not the x y z
/// w of a quaternion.
std::optional<TrajectoryLayout> trajectory_layout_by_names(const LineReader& lines, std::string_view header,
                                                           std::size_t columns);

/// The layout of rows without names, by the cells of the first one. Throws InputError for numbers of columns that could
/// be several things, or nothing known.
TrajectoryLayout trajectory_layout_by_count(const RowReader& first_row);

}  // namespace cmap
