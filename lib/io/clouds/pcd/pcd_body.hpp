#pragma once

#include <cstddef>
#include <vector>

#include "clouds/columns.hpp"
#include "clouds/pcd/pcd_header.hpp"
#include "cmap/core/array.hpp"
#include "cmap/io/byte_source.hpp"

namespace cmap {

/// The decompressed body of a binary_compressed PCD file: field by field, each with all its points.
Array<std::byte> read_compressed_pcd_body(ByteSource& source, std::uint64_t points, std::size_t record_bytes);

/// The columns of such a body, one for each field.
std::vector<Column> compressed_columns(const PcdHeader& header, const Array<std::byte>& body);

}  // namespace cmap
