#include <bit>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/ply/ply_header.hpp"
#include "clouds/ply/ply_rest.hpp"
#include "clouds/ply/ply_rows.hpp"
#include "clouds/record_reader.hpp"

namespace cmap {
namespace {

std::string_view format_name(PlyFormat format) {
  switch (format) {
    case PlyFormat::kAscii:
      return "PLY ascii";
    case PlyFormat::kLittleEndian:
      return "PLY binary little endian";
    case PlyFormat::kBigEndian:
      break;
  }
  return "PLY binary big endian";
}

bool needs_swap(PlyFormat format) {
  return (format == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big);
}

void skip_ascii_element(LineReader& lines, const PlyElement& element) {
  if (element.properties.empty()) return;
  std::string_view line;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!lines.next(line))
      lines.fail("truncated: the file ends after {} of {} rows of '{}'", i, element.count, element.name);
  }
}

void skip_binary_element(ByteSource& source, const PlyElement& element, bool swap_bytes) {
  if (element.properties.empty()) return;
  const std::uint64_t bytes = element.row_bytes();
  // Rows with lists have at least one byte for each property.
  const std::uint64_t least = element.has_lists() ? element.properties.size() : bytes;
  if (element.count > source.remaining() / least) {
    source.fail("truncated: {} rows of element '{}' from byte {} on do not fit into {} bytes", element.count,
                element.name, source.position(), source.size());
  }
  if (!element.has_lists()) return source.skip(element.count * bytes, "element '" + element.name + "'");
  PlyRowWalker walker(source, element, swap_bytes);
  for (std::uint64_t i = 0; i < element.count; ++i) walker.next(nullptr);
}

/// Points between whose scalars lie lists: the scalars are gathered into records without them.
PointCloud read_rows_with_lists(ByteSource& source, const PlyElement& vertex, const PointSchema& schema,
                                bool swap_bytes, FileInfo& info) {
  if (vertex.count > source.remaining() / vertex.properties.size()) {
    source.fail("truncated: {} points of {} properties from byte {} on do not fit into {} bytes", vertex.count,
                vertex.properties.size(), source.position(), source.size());
  }
  // In the packed record a list takes no room.
  std::vector<Field> packed_fields = vertex.properties;
  for (Field& field : packed_fields) {
    if (field.list_count_type) field.count = 0;
  }
  RecordLayout layout = record_layout(source, packed_fields, schema);
  layout.columns.swap_bytes = swap_bytes;
  CloudBuilder builder(source, schema.layout, vertex.count);
  PlyRowWalker walker(source, vertex, swap_bytes);
  constexpr std::size_t kRows = 256;
  std::vector<std::byte> records(kRows * layout.bytes);
  for (std::uint64_t done = 0; done < vertex.count;) {
    std::size_t n = 0;
    for (; n < kRows && done < vertex.count; ++n, ++done) walker.next(records.data() + n * layout.bytes);
    builder.append(columns_at(layout, records.data()), n);
  }
  return builder.finish(info);
}

PointCloud read_vertices(LineReader& lines, const PlyHeader& header, const PointSchema& schema, FileInfo& info) {
  ByteSource& source = lines.source();
  const PlyElement& vertex = header.elements[header.vertex];
  const bool swap_bytes = needs_swap(header.format);
  if (header.format == PlyFormat::kAscii) {
    require_ascii_rows(source, vertex.count, vertex.properties);
    CloudBuilder builder(source, schema.layout, vertex.count);
    read_ascii_rows(lines, vertex.count, vertex.properties, schema, builder);
    return builder.finish(info);
  }
  if (vertex.has_lists()) return read_rows_with_lists(source, vertex, schema, swap_bytes, info);
  RecordLayout layout = record_layout(source, vertex.properties, schema);
  layout.columns.swap_bytes = swap_bytes;
  require_records(source, vertex.count, layout.bytes);
  CloudBuilder builder(source, schema.layout, vertex.count);
  read_records(source, vertex.count, layout, builder);
  return builder.finish(info);
}

/// Steps over what comes before the points.
void skip_elements(LineReader& lines, const PlyHeader& header) {
  for (std::size_t e = 0; e < header.vertex; ++e) {
    if (header.format == PlyFormat::kAscii) {
      skip_ascii_element(lines, header.elements[e]);
    } else {
      skip_binary_element(lines.source(), header.elements[e], needs_swap(header.format));
    }
  }
}

PointCloud read_ply(ByteSource& source, FileInfo& info) {
  LineReader lines(source);
  const PlyHeader header = read_ply_header(lines);
  info.format = format_name(header.format);
  const PointSchema schema = find_point_schema(source, header.elements[header.vertex].properties, info);
  skip_elements(lines, header);
  PointCloud cloud = read_vertices(lines, header, schema, info);
  check_ply_rest(lines, header, needs_swap(header.format), info);
  return cloud;
}

}  // namespace

namespace formats {

extern constinit const CloudFormat ply{
    .name = "PLY",
    .listed = "PLY",
    .by_content =
        [](const FileStart& start) { return start.bytes.starts_with("ply\n") || start.bytes.starts_with("ply\r"); },
    .by_name = [](const FileStart& start) { return start.extension == ".ply"; },
    .read = without_options<read_ply>};

}  // namespace formats

}  // namespace cmap
