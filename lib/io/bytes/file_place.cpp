#include "cmap/io/file_place.hpp"

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

}  // namespace cmap
