#include <algorithm>
#include <bit>

#include "io/format_readers.hpp"
#include "io/las_header.hpp"
#include "io/record_reader.hpp"

namespace cmap {
namespace {

RecordLayout las_layout(const LasHeader& header) {
  RecordLayout layout;
  layout.bytes = header.record_bytes;
  layout.columns.swap_bytes = std::endian::native == std::endian::big;
  layout.columns.scaled = true;
  layout.columns.scale = header.scale;
  layout.columns.offset = header.offset;
  for (std::size_t k = 0; k < 3; ++k) {
    layout.position_offsets[k] = 4 * k;
    layout.columns.position[k].type = ScalarType::kInt32;
    layout.color_offsets[k] = header.rgb_offset + 2 * k;
    layout.columns.rgb[k].type = ScalarType::kUint16;
  }
  if (header.rgb_offset > 0) layout.columns.color = ColorStorage::kSeparate;
  return layout;
}

}  // namespace

PointCloud read_las(ByteSource& source, FileInfo& info) {
  const LasHeader header = read_las_header(source);
  info.format = fmt::format("LAS 1.{} format {}", header.version_minor, header.point_format);
  source.skip(header.data_offset, "all that comes before the points");
  require_records(source, header.points, header.record_bytes);
  const RecordLayout layout = las_layout(header);
  CloudBuilder builder(source, {true, {layout.columns.color, ScalarType::kUint16}}, header.points);
  read_records(source, header.points, layout, builder);
  return builder.finish(info);
}

}  // namespace cmap
