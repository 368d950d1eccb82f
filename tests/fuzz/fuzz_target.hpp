#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cmap/core/error.hpp"
#include "io/format_readers.hpp"

namespace cmap::fuzz {

using Reader = PointCloud (*)(ByteSource&, FileInfo&);

/// One input for one reader, which must read it or refuse it. The small blocks of a source in memory make the input
/// cross their borders.
inline void try_reader(Reader reader, std::span<const std::byte> input) {
  try {
    ByteSource source("input", input);
    FileInfo info;
    const PointCloud cloud = reader(source, info);
    if (cloud.size() != info.finite_points || cloud.size() == 0) __builtin_trap();
    for (const Eigen::Vector3f& p : cloud.positions) {
      if (!p.allFinite()) __builtin_trap();
    }
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

inline int run(Reader reader, const std::uint8_t* data, std::size_t size) {
  try_reader(reader, std::as_bytes(std::span(data, size)));
  return 0;
}

}  // namespace cmap::fuzz
