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
  if (header.rgb_offset > 0) layout.columns.color = ColorStorage::kRgb16;
  return layout;
}

/// Many writers put 8-bit values into the 16-bit fields, against the specification.
void recognize_8bit_colors(Colors& colors, FileInfo& info) {
  const auto* wide = std::get_if<Array<Rgb16>>(&colors);
  if (wide == nullptr) return;
  std::uint16_t highest = 0;
  for (const Rgb16& color : *wide) highest = std::max({highest, color[0], color[1], color[2]});
  if (highest > 255) return;
  info.notes.emplace_back(highest > 0 ? "8-bit colors in 16-bit fields"
                                      : "all colors are black: probably none were stored");
  Array<Rgb8> narrow(wide->size());
  std::transform(wide->begin(), wide->end(), narrow.begin(), [](const Rgb16& color) {
    return Rgb8{static_cast<std::uint8_t>(color[0]), static_cast<std::uint8_t>(color[1]),
                static_cast<std::uint8_t>(color[2])};
  });
  colors = std::move(narrow);
}

}  // namespace

PointCloud read_las(ByteSource& source, FileInfo& info) {
  const LasHeader header = read_las_header(source);
  info.format = fmt::format("LAS 1.{} format {}", header.version_minor, header.point_format);
  source.skip(header.data_offset, "all that comes before the points");
  require_records(source, header.points, header.record_bytes);
  const RecordLayout layout = las_layout(header);
  CloudBuilder builder(source, {true, layout.columns.color, {"red", "green", "blue"}}, header.points);
  read_records(source, header.points, layout, builder);
  PointCloud cloud = builder.finish(info);
  recognize_8bit_colors(cloud.colors, info);
  return cloud;
}

}  // namespace cmap
