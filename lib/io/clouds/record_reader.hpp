#pragma once

#include <algorithm>
#include <span>

#include "clouds/cloud_builder.hpp"
#include "clouds/point_schema.hpp"
#include "cmap/io/byte_source.hpp"

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

/// Refuses a binary file that holds more bytes than its header says: with a size of records that is wrong, all but the
/// first point would be read shifted.
[[noreturn]] void refuse_bytes_left_over(const ByteSource& source, std::uint64_t n_bytes, std::uint64_t n_points);

/// The columns of the records that start at `data`.
PointColumns columns_at(const RecordLayout& layout, const std::byte* data);

/// Calls use(data, count) for n records, block by block. Throws InputError if the file holds fewer.
template <class Use>
void for_each_block(ByteSource& source, std::uint64_t n, std::size_t record_bytes, Use&& use) {
  while (n > 0) {
    const auto window = source.peek(record_bytes);
    if (window.size() < record_bytes) require_records(source, n, record_bytes);
    const std::size_t count = std::min<std::uint64_t>(n, window.size() / record_bytes);
    use(window.data(), count);
    source.advance(count * record_bytes);
    n -= count;
  }
}

}  // namespace cmap
