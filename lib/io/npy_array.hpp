#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/io/output_file.hpp"
#include "io/byte_source.hpp"

namespace cmap {

/// The types of a NumPy array that can be read, all little endian.
enum class NpyType { kFloat16, kFloat32, kFloat64, kUint8, kBool, kInt32, kInt64 };

std::size_t npy_type_bytes(NpyType type);
/// As NumPy writes it: "<f4".
std::string_view npy_type_name(NpyType type);

struct NpyHeader {
  NpyType type = NpyType::kFloat32;
  std::vector<std::uint64_t> shape;
  std::uint64_t values = 0;  ///< product of the shape
};

/// Reads the header of an NPY file (version 1.0 to 3.0; the format is numpy.lib.format's). Throws InputError naming the
/// source for anything but a C-ordered little-endian array of a type above: Fortran order, big-endian values, records,
/// pickled objects, a shape whose product overflows.
NpyHeader read_npy_header(ByteSource& source);

/// Whether a source that starts with these bytes is an array of pickled objects, which nothing but Python reads.
bool holds_python_objects(std::string_view start_of_npy);

/// An array as a file holds it: row-major values, the last index fastest.
struct NpyArray {
  std::string name;  ///< file and member, for messages
  NpyHeader header;
  Array<std::byte> bytes;

  const std::vector<std::uint64_t>& shape() const { return header.shape; }
  std::size_t size() const { return header.values; }

  /// The values as another type; every type of NpyType becomes any floating one.
  Array<float> to_floats() const;
  Array<double> to_doubles() const;
  /// Of bytes and booleans alone. Throws InputError for another type.
  Array<std::uint8_t> to_bytes() const;

  /// Throws InputError "<name>: <reason>".
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    throw InputError(name + ": " + fmt::format(reason, std::forward<Args>(args)...));
  }
};

/// Reads a whole NPY file. Throws InputError as read_npy_header, and unless the values fill the rest of the source.
NpyArray read_npy(ByteSource& source);

/// "(17, 154, 518)".
std::string shape_text(const std::vector<std::uint64_t>& shape);

/// Writes an NPY 1.0 file; `data` holds the values of the shape.
void write_npy(OutputFile& file, NpyType type, const std::vector<std::uint64_t>& shape, const void* data);

}  // namespace cmap
