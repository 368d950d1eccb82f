#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

// What cannot be looked at, as its name is too long or a folder above it is closed, is none of these.
bool is_there(const std::filesystem::path& path);
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

/// What is in a folder, in no order. Throws InputError where it cannot be looked into.
std::vector<std::filesystem::path> paths_in(const std::filesystem::path& folder);

}  // namespace cmap
