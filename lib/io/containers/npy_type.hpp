#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes/scalar_type.hpp"
#include "containers/npy_header_text.hpp"

namespace cmap {

/// What a value is: kOther stands for what is stepped over (text, dates, complex numbers, long doubles, raw bytes).
enum class NpyKind { kNumber, kHalf, kBool, kOther };

/// A member of each item of an array: the only one, without a name, of a plain array; one of several of a record.
struct NpyField {
  std::string name;    ///< of padding: empty
  std::string parent;  ///< of a record in a record: the name of the outer one
  std::string type;    ///< as NumPy writes it: "<f4"
  NpyKind kind = NpyKind::kNumber;
  ScalarType scalar = ScalarType::kFloat32;  ///< kHalf: float32, which it becomes; kBool: uint8
  bool big_endian = false;
  std::size_t value_bytes = 4;       ///< as stored
  std::vector<std::uint64_t> shape;  ///< of a member that is an array itself
  std::size_t count = 1;             ///< product of the shape
  std::size_t offset = 0;            ///< bytes from the start of the item

  std::size_t bytes() const { return value_bytes * count; }
};

/// Parses the 'descr' of a header: a type, or a list of (name, type[, shape]) whose types may be lists again (then
/// flattened). Throws InputError for pickled objects, an unknown type, an item without bytes or of more than
/// ByteSource::kMaxRecordBytes.
std::vector<NpyField> take_npy_fields(NpyHeaderText& text);

/// Whether a member of this name is x, y and z together: "xyz", "Position", "points", ...
bool is_position_name(std::string_view name);

/// "<f4"
std::string npy_type_name(ScalarType type);

}  // namespace cmap
