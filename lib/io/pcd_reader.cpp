#include <bit>
#include <cstring>

#include "io/ascii_rows.hpp"
#include "io/format_readers.hpp"
#include "io/lzf_codec.hpp"
#include "io/pcd_header.hpp"
#include "io/record_reader.hpp"

namespace cmap {
namespace {

// PCD has no byte order of its own; every writer there is writes little endian.
constexpr bool kSwapBytes = std::endian::native == std::endian::big;

std::uint32_t read_size(ByteSource& source) {
  std::array<std::byte, 4> bytes;
  source.read(bytes, "a size of the compressed body");
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  return size;
}

/// The decompressed body: field by field, each with all its points.
Array<std::byte> read_compressed_body(ByteSource& source, std::uint64_t points, std::size_t record_bytes) {
  const std::uint64_t start = source.position();
  const std::uint32_t compressed_bytes = read_size(source);
  const std::uint32_t body_bytes = read_size(source);
  if (points > body_bytes / record_bytes || points * record_bytes != body_bytes) {
    source.fail("byte {}: {} points of {} bytes do not make the {} bytes that the compressed body declares", start + 4,
                points, record_bytes, body_bytes);
  }
  source.require(compressed_bytes, "the compressed body");
  if (body_bytes > lzf_max_size(compressed_bytes)) {
    source.fail("byte {}: {} compressed bytes cannot hold {}", start, compressed_bytes, body_bytes);
  }
  Array<std::byte> compressed(compressed_bytes);
  source.read(compressed, "the compressed body");
  Array<std::byte> body(body_bytes);
  if (!lzf_expand(compressed, body)) source.fail("byte {}: the compressed body is damaged", start + 8);
  return body;
}

void read_compressed(ByteSource& source, const PcdHeader& header, const RecordLayout& layout, const PointSchema& schema,
                     CloudBuilder& builder) {
  const Array<std::byte> body = read_compressed_body(source, header.points, layout.bytes);
  std::vector<Column> field_columns;
  const std::byte* place = body.data();
  for (const Field& field : header.fields) {
    const std::size_t bytes = field.count * scalar_bytes(field.type);
    field_columns.push_back({place, bytes, field.type});
    place += header.points * bytes;
  }
  PointColumns columns = layout.columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k] = field_columns[schema.position[k]];
    columns.rgb[k] = field_columns[schema.color_fields[k]];
  }
  builder.append(columns, header.points);
}

}  // namespace

PointCloud read_pcd(ByteSource& source, FileInfo& info) {
  LineReader lines(source);
  info.format = "PCD";
  const PcdHeader header = read_pcd_header(lines, info);
  const PointSchema schema = find_point_schema(source, header.fields, info);
  if (header.data == PcdData::kAscii) {
    info.format = "PCD ascii";
    require_ascii_rows(source, header.points, header.fields);
    CloudBuilder builder(source, schema.layout, header.points);
    read_ascii_rows(lines, header.points, header.fields, schema, builder);
    return builder.finish(info);
  }
  RecordLayout layout = record_layout(source, header.fields, schema);
  layout.columns.swap_bytes = kSwapBytes;
  if (header.data == PcdData::kBinary) {
    info.format = "PCD binary";
    require_records(source, header.points, layout.bytes);
    CloudBuilder builder(source, schema.layout, header.points);
    read_records(source, header.points, layout, builder);
    return builder.finish(info);
  }
  info.format = "PCD compressed";
  if (header.points > lzf_max_size(source.remaining()) / layout.bytes)
    require_records(source, header.points, layout.bytes);
  CloudBuilder builder(source, schema.layout, header.points);
  read_compressed(source, header, layout, schema, builder);
  return builder.finish(info);
}

}  // namespace cmap
