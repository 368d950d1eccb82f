#include "clouds/record_reader.hpp"

namespace cmap {

RecordLayout record_layout(const ByteSource& source, std::span<const Field> fields, const PointSchema& schema) {
  RecordLayout layout;
  std::vector<std::size_t> offsets;
  for (const Field& field : fields) {
    offsets.push_back(layout.bytes);
    const std::size_t bytes = scalar_bytes(field.type);
    if (field.count > ByteSource::kMaxRecordBytes / bytes) layout.bytes = ByteSource::kMaxRecordBytes;
    layout.bytes += field.count * bytes;
    if (layout.bytes > ByteSource::kMaxRecordBytes) {
      source.fail("header: a point takes more than the accepted {} bytes", ByteSource::kMaxRecordBytes);
    }
  }
  layout.columns.color = schema.layout.color.storage;
  for (std::size_t k = 0; k < 3; ++k) {
    layout.position_offsets[k] = offsets[schema.position[k]];
    layout.columns.position[k].type = fields[schema.position[k]].type;
    layout.color_offsets[k] = offsets[schema.color_fields[k]];
    layout.columns.rgb[k].type = fields[schema.color_fields[k]].type;
  }
  return layout;
}

void require_records(const ByteSource& source, std::uint64_t n, std::size_t record_bytes) {
  if (n > source.remaining() / record_bytes) {
    source.fail("truncated: {} points of {} bytes from byte {} on do not fit into {} bytes", n, record_bytes,
                source.position(), source.size());
  }
}

PointColumns columns_at(const RecordLayout& layout, const std::byte* data) {
  PointColumns columns = layout.columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k].data = data + layout.position_offsets[k];
    columns.rgb[k].data = data + layout.color_offsets[k];
    columns.position[k].stride = columns.rgb[k].stride = layout.bytes;
  }
  return columns;
}

void refuse_bytes_left_over(const ByteSource& source, std::uint64_t n_bytes, std::uint64_t n_points) {
  const std::string each =
      n_points > 0 && n_bytes % n_points == 0
          ? fmt::format(", exactly {} a point, of which the header does not tell", n_bytes / n_points)
          : "";
  source.fail("{} bytes are left over after all that the header says{}; the points would be read shifted", n_bytes,
              each);
}

void read_records(ByteSource& source, std::uint64_t n, const RecordLayout& layout, CloudBuilder& builder) {
  for_each_block(source, n, layout.bytes,
                 [&](const std::byte* data, std::size_t count) { builder.append(columns_at(layout, data), count); });
}

}  // namespace cmap
