#include <algorithm>
#include <bit>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/pcd/pcd_body.hpp"
#include "clouds/pcd/pcd_header.hpp"
#include "clouds/record_reader.hpp"
#include "containers/lzf_codec.hpp"

namespace cmap {
namespace {

// PCD has no byte order of its own; every writer there is writes little endian.
constexpr bool kSwapBytes = std::endian::native == std::endian::big;

void read_compressed(ByteSource& source, const PcdHeader& header, const RecordLayout& layout, const PointSchema& schema,
                     CloudBuilder& builder) {
  const Array<std::byte> body = read_compressed_pcd_body(source, header.points, layout.bytes);
  const std::vector<Column> field_columns = compressed_columns(header, body);
  PointColumns columns = layout.columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k] = field_columns[schema.position[k]];
    columns.rgb[k] = field_columns[schema.color_fields[k]];
  }
  builder.append(columns, header.points);
}

/// Points whose records the header gives the wrong size are read shifted. Zeros at the end are what mapped files keep.
void check_bytes_left_over(ByteSource& source, std::uint64_t points, FileInfo& info) {
  const std::uint64_t n = source.remaining();
  if (n == 0) return;
  bool empty = true;
  for (auto bytes = source.peek(1); !bytes.empty() && empty; bytes = source.peek(1)) {
    empty = std::all_of(bytes.begin(), bytes.end(),
                        [](std::byte b) { return b == std::byte{0} || b == std::byte{'\n'} || b == std::byte{'\r'}; });
    source.advance(bytes.size());
  }
  if (!empty) refuse_bytes_left_over(source, n, points);
  if (n > 2) info.notes.push_back(fmt::format("{} bytes of nothing follow the points; not read", n));
}

/// A PCD file may start with comments and with any of its keywords.
bool is_pcd(const FileStart& start) {
  for (const std::string_view line : start.lines(100)) {
    if (line.starts_with("# .PCD") || line.starts_with("VERSION ") || line.starts_with("FIELDS ")) return true;
    if (!line.starts_with("#") && line.find_first_not_of(" \t") != std::string_view::npos) return false;
  }
  return false;
}

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
    note_lines_left_over(lines, info);
    return builder.finish(info);
  }
  RecordLayout layout = record_layout(source, header.fields, schema);
  layout.columns.swap_bytes = kSwapBytes;
  if (header.data == PcdData::kBinary) {
    info.format = "PCD binary";
    require_records(source, header.points, layout.bytes);
    CloudBuilder builder(source, schema.layout, header.points);
    read_records(source, header.points, layout, builder);
    if (header.points > 0) check_bytes_left_over(source, header.points, info);
    return builder.finish(info);
  }
  info.format = "PCD compressed";
  if (header.points > lzf_max_size(source.remaining()) / layout.bytes)
    require_records(source, header.points, layout.bytes);
  CloudBuilder builder(source, schema.layout, header.points);
  read_compressed(source, header, layout, schema, builder);
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat pcd{.name = "PCD",
                                       .listed = "PCD",
                                       .by_content = is_pcd,
                                       .by_name = [](const FileStart& start) { return start.extension == ".pcd"; },
                                       .read = without_options<read_pcd>};

}  // namespace formats

}  // namespace cmap
