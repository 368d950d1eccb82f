#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cmap/core/warning.hpp"
#include "io/npy_array.hpp"
#include "io/zip_archive.hpp"

namespace cmap {

/// Named arrays: `<name>.npy` in a folder or in an NPZ file. Errors name file and member. Not thread-safe.
class ArrayStore {
 public:
  explicit ArrayStore(const std::filesystem::path& folder_or_npz);
  ArrayStore(std::string name, std::span<const std::byte> npz);

  bool has(std::string_view name) const;
  /// Throws InputError if there is none, or it is not what read_npy() reads.
  NpyArray read(std::string_view name) const;
  /// Members of an NPZ file that only Python reads.
  std::vector<std::string> python_members() const;
  const ZipArchive* archive() const { return zip_ ? &*zip_ : nullptr; }

 private:
  std::filesystem::path folder_;
  std::optional<ZipArchive> zip_;
};

/// Throws InputError unless the array has this shape; a length of 0 stands for any.
void require_shape(const NpyArray& array, const std::vector<std::uint64_t>& shape);

}  // namespace cmap
