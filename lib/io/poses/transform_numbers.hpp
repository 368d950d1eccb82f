#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "cmap/io/byte_source.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {

/// The numbers that a file gives for a transform, in their order.
struct TransformNumbers {
  std::vector<double> values;
  std::vector<std::size_t> rows;  ///< how many numbers each row holds; one row: all in a list
  bool column_major = false;      ///< the list is known to hold column after column
};

/// From text, plain or printed by a program. Throws InputError for what is no finite number.
TransformNumbers transform_from_text(const ByteSource& source, std::string_view text);

/// From JSON. Throws InputError unless it holds one matrix, or one named "T".
TransformNumbers transform_from_json(const ByteSource& source, const std::string& text);

/// From a NumPy array of shape (4, 4), (3, 4), (16,) or (12,), also as the only one of a batch.
TransformNumbers transform_from_npy(ByteSource& source);

/// Whether a name clearly says that a matrix maps the reference to the estimate ("T_est_ref", "ref_to_est"), and so not
/// as every transform here does, the estimate to the reference.
bool names_reference_to_estimate(std::string_view name);

/// Why such a matrix is refused, and what helps.
std::string reference_to_estimate_error(std::string_view name, std::string_view how_to_invert);

/// The transform of a whole source (see read_transform).
TransformFile parse_transform(ByteSource& source);

}  // namespace cmap
