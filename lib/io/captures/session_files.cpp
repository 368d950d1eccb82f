#include "captures/session_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

bool has_neighbors(const fs::path& npz) {
  const fs::path folder = npz.has_parent_path() ? npz.parent_path() : ".";
  return std::ranges::any_of(paths_in(folder), [&](const fs::path& path) {
    return path.extension() == ".npz" && path.filename() != npz.filename();
  });
}

/// A lone NPZ file, and one in a folder of its own, may have a frames.csv as well.
fs::path frames_of_npz(const fs::path& npz, bool is_in_own_folder) {
  const fs::path own = own_frames_of(npz), common = npz.parent_path() / "frames.csv";
  if (is_there(own) || !is_there(common)) return own;
  if (is_in_own_folder || !has_neighbors(npz)) return common;
  throw InputError(
      fmt::format("{}: no such file; the times of the frames of {} are expected there, as {} could be those "
                  "of any of several .npz",
                  own.string(), npz.filename().string(), common.string()));
}

}  // namespace

fs::path own_frames_of(const fs::path& npz) { return npz.parent_path() / (npz.stem().string() + ".frames.csv"); }

SessionFiles find_session_files(const fs::path& folder_or_npz) {
  const fs::path& path = folder_or_npz;
  if (!is_there(path)) throw InputError(path.string() + ": no such file or folder; a session's predictions expected");
  if (!is_folder(path)) return {path, frames_of_npz(path, false), {}};
  const fs::path inside = path / "predictions.npz";
  if (is_there(path / "depth.npy") || !is_there(inside)) return {path, path / "frames.csv", path / "meta.json"};
  return {inside, frames_of_npz(inside, true), {}};
}

}  // namespace cmap
