#include "cmap/io/file_place.hpp"

#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {

namespace fs = std::filesystem;

std::string file_name(const fs::path& path) { return path.filename().string(); }

std::string name_of_input(const fs::path& path) { return path == kStandardStream ? "standard input" : path.string(); }

fs::path place_of_file(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as many as the system follows
  std::error_code error;
  fs::path place = fs::absolute(path.has_filename() ? path : path.parent_path(), error);
  for (int i = 0; i < kMostLinks && fs::is_symlink(place, error); ++i) {
    place = place.parent_path() / fs::read_symlink(place, error);
  }
  const fs::path folder = fs::weakly_canonical(place.parent_path(), error);
  return ((error ? place.parent_path() : folder) / place.filename()).lexically_normal();
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::vector<fs::path> paths_in(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    paths.push_back(entry->path());
  }
  if (error) throw InputError(fmt::format("{}: cannot be looked into: {}", folder.string(), error.message()));
  return paths;
}

}  // namespace cmap
