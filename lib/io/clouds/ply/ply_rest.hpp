#pragma once

#include "clouds/ply/ply_header.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// What follows the points of a PLY file, which has just been read up to there: says that a mesh was read as its
/// vertices, and what else is not used; warns of a file that ends within elements with lists. Throws InputError where
/// a binary file of fixed-size elements is shorter or longer than its header says: its points were read shifted.
void check_ply_rest(LineReader& lines, const PlyHeader& header, bool swap_bytes, FileInfo& info);

}  // namespace cmap
