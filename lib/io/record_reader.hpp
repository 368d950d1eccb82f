#pragma once

#include <span>

#include "io/byte_source.hpp"
#include "io/cloud_builder.hpp"
#include "io/point_schema.hpp"

namespace cmap {

/// Points in binary records of one size.
struct RecordLayout {
  std::size_t bytes = 0;
  std::array<std::size_t, 3> position_offsets{};  ///< in bytes, from the start of a record
  std::array<std::size_t, 3> color_offsets{};
  PointColumns columns;  ///< all but the memory
};

/// The layout of fields that follow each other without gaps. Throws InputError if a record is absurdly large.
RecordLayout record_layout(const ByteSource& source, std::span<const Field> fields, const PointSchema& schema);

/// Reads n records. Throws InputError if the file holds fewer; call it before memory for them is taken.
void require_records(const ByteSource& source, std::uint64_t n, std::size_t record_bytes);
void read_records(ByteSource& source, std::uint64_t n, const RecordLayout& layout, CloudBuilder& builder);

/// The columns of the records that start at `data`.
PointColumns columns_at(const RecordLayout& layout, const std::byte* data);

}  // namespace cmap
