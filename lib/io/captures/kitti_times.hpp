#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace cmap {

/// A file of times of KITTI's raw data, a line each: "2011-09-26 13:02:25.594360375", taken for UTC. Throws InputError
/// naming file, line and reason.
std::vector<double> read_kitti_times(const std::filesystem::path& path);

/// The number that is a file's name: 0000000012.bin. Throws InputError for another name.
std::size_t kitti_number(const std::filesystem::path& path);

}  // namespace cmap
