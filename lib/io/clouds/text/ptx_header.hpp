#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "cmap/io/line_reader.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// What the ten lines before a scan of a PTX file say: columns, rows, the scanner's position, its axes, a matrix.
struct PtxScan {
  std::size_t index = 0;        ///< in the file, from 1
  std::uint64_t grid_rows = 0;  ///< lines announced: columns times rows
  Eigen::Vector3d sensor;       ///< the scanner's position, world frame, meters
  Eigen::Matrix4d T_rows;       ///< moves row vectors: (x y z 1) * T_rows
};

/// Reads the header whose first line is `line`. Throws InputError for one that is cut or is none; allocates nothing.
PtxScan read_ptx_header(LineReader& lines, std::string_view line, std::size_t index, FileInfo& info);

/// The next line that is not blank; false at the end of the file.
bool next_filled_line(LineReader& lines, std::string_view& line);

}  // namespace cmap
