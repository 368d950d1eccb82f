#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cmap/core/warning.hpp"
#include "containers/npy_array.hpp"
#include "containers/zip_archive.hpp"

namespace cmap {

/// A member of an NPZ file, as far as its first bytes tell.
struct NpzEntry {
  std::string name;                 ///< of an array: without ".npy"
  std::optional<NpyHeader> header;  ///< none: no array that can be read
};

/// Named arrays: `<name>.npy` in a folder or in an NPZ file. Errors name file and member. Not thread-safe.
class ArrayStore {
 public:
  explicit ArrayStore(const std::filesystem::path& folder_or_npz);
  ArrayStore(std::string name, std::span<const std::byte> npz);

  bool has(std::string_view name) const;
  /// What messages call this array.
  std::string name_of(std::string_view name) const;
  /// Throws InputError if there is none, or it is not what read_npy() reads.
  NpyArray read(std::string_view name) const;
  /// Every member of an NPZ file, in its order.
  std::vector<NpzEntry> entries() const;
  /// Members of an NPZ file that only Python reads.
  std::vector<std::string> python_members() const;
  const ZipArchive* archive() const { return zip_ ? &*zip_ : nullptr; }

 private:
  std::filesystem::path folder_;
  std::optional<ZipArchive> zip_;
};

/// Throws InputError unless the array has this shape; a length of 0 stands for any.
void require_shape(const NpyArray& array, const std::vector<std::uint64_t>& shape);

/// Brings the shape to this number of dimensions: drops a 1 at the end, which VGGT keeps of depths, and a batch
/// dimension of 1 in front. Throws InputError for a batch of several.
void drop_ones(NpyArray& array, std::size_t dimensions);

}  // namespace cmap
