#pragma once

#include <filesystem>
#include <string>

namespace cmap {

/// In place of a file's name: standard input where something is read, standard output where something is written.
inline constexpr const char* kStandardStream = "-";

/// The name of a file without its folders: what is shown to others.
std::string file_name(const std::filesystem::path& path);

/// How messages and reports name an input.
std::string name_of_input(const std::filesystem::path& path);

/// The file that a path leads to, whatever its spelling: absolute, without "." and "..", links followed, also those
/// that lead to nothing yet.
std::filesystem::path place_of_file(const std::filesystem::path& path);

}  // namespace cmap
