#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/output_file.hpp"
#include "containers/npy_type.hpp"

namespace cmap {

struct NpyHeader {
  std::vector<NpyField> fields;  ///< at least one; see NpyField
  std::vector<std::uint64_t> shape;
  bool fortran_order = false;
  std::uint64_t items = 0;     ///< product of the shape
  std::size_t item_bytes = 0;  ///< of all fields

  bool is_record() const { return fields.size() > 1 || !fields[0].name.empty(); }
  /// "<f4", or "records of x, y, z".
  std::string type_text() const;
};

/// Reads the header of an NPY file (version 1.0 to 3.0; the format is numpy.lib.format's). Throws InputError naming the
/// source as take_npy_fields does, and for a shape whose product overflows.
NpyHeader read_npy_header(ByteSource& source);

/// Whether a source that starts with these bytes is an array of pickled objects, which nothing but Python reads.
bool holds_python_objects(std::string_view start_of_npy);

/// An array in memory, brought into one form: little endian, the last index fastest, half floats as float32.
struct NpyArray {
  std::string name;   ///< file and member, for messages
  std::string label;  ///< within an NPZ file: the array's name
  NpyHeader header;
  Array<std::byte> bytes;

  const std::vector<std::uint64_t>& shape() const { return header.shape; }
  std::size_t size() const { return header.items; }

  /// The values as another type; every number and truth value becomes any floating one. Throws InputError for others.
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
void write_npy(OutputFile& file, ScalarType type, const std::vector<std::uint64_t>& shape, const void* data);

}  // namespace cmap
