#pragma once

#include <filesystem>

namespace cmap {

/// Where the parts of a session's predictions lie.
struct SessionFiles {
  std::filesystem::path arrays;  ///< folder or NPZ file
  std::filesystem::path frames;  ///< CSV
  std::filesystem::path meta;    ///< empty: an NPZ file has none
};

/// NAME.frames.csv beside NAME.npz.
std::filesystem::path own_frames_of(const std::filesystem::path& npz);

/// Throws InputError where there is no such session, or its frames could be those of another NPZ file.
SessionFiles find_session_files(const std::filesystem::path& folder_or_npz);

}  // namespace cmap
