#pragma once

#include <cstddef>
#include <vector>

#include "clouds/ply/ply_header.hpp"
#include "cmap/io/byte_source.hpp"

namespace cmap {

/// Walks binary rows that contain lists, and so have no fixed size.
class PlyRowWalker {
 public:
  PlyRowWalker(ByteSource& source, const PlyElement& element, bool swap_bytes);

  /// Bytes of a row's scalars, one after the other.
  std::size_t packed_bytes() const { return packed_bytes_; }
  /// Steps over one row; where `packed` is not null, copies its scalars there.
  void next(std::byte* packed);

 private:
  /// A run of scalars (`scalar_bytes`), or a list.
  struct Step {
    std::size_t run_bytes = 0;
    ScalarType count_type = ScalarType::kUint8;
    std::size_t item_bytes = 0;  ///< 0 for a run
  };
  std::uint64_t read_count(ScalarType type);

  ByteSource& source_;
  std::string what_;
  bool swap_bytes_;
  std::vector<Step> steps_;
  std::size_t packed_bytes_ = 0;
};

}  // namespace cmap
