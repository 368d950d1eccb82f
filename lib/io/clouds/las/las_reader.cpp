#include <algorithm>
#include <bit>
#include <cmath>

#include "clouds/cloud_format.hpp"
#include "clouds/las/las_header.hpp"
#include "clouds/las/las_records.hpp"
#include "clouds/las/las_selection.hpp"
#include "clouds/las/las_units.hpp"
#include "clouds/record_reader.hpp"

namespace cmap {
namespace {

RecordLayout las_layout(const LasHeader& header, const std::array<double, 3>& unit_m) {
  RecordLayout layout;
  layout.bytes = header.record_bytes;
  layout.columns.swap_bytes = std::endian::native == std::endian::big;
  layout.columns.scaled = true;
  for (std::size_t k = 0; k < 3; ++k) {
    layout.columns.scale[k] = header.scale[k] * unit_m[k];
    layout.columns.offset[k] = header.offset[k] * unit_m[k];
    layout.position_offsets[k] = 4 * k;
    layout.columns.position[k].type = ScalarType::kInt32;
    layout.color_offsets[k] = header.rgb_offset + 2 * k;
    layout.columns.rgb[k].type = ScalarType::kUint16;
  }
  if (header.rgb_offset > 0) layout.columns.color = ColorStorage::kSeparate;
  return layout;
}

/// A header that was not completed, and two counts that contradict each other. The source stands at the points.
void check_counts(const ByteSource& source, const LasHeader& header, FileInfo& info) {
  require_records(source, header.points, header.record_bytes);
  if (header.legacy_points > 0 && header.legacy_points != header.points) {
    info.warnings.push_back({"two_counts", fmt::format("the header counts {} points in its 64-bit field, {} in its old "
                                                       "32-bit field; the first counts",
                                                       header.points, header.legacy_points)});
  }
}

/// What lies behind the points and is no record is said: it may be points.
void check_rest(const ByteSource& source, const LasHeader& header, const LasRecords& records, FileInfo& info) {
  const std::uint64_t rest = source.size() - header.data_end() - records.extended_bytes;
  const std::uint64_t room = rest / header.record_bytes;
  if (rest == 0) return;
  if (header.points == 0 && room > 0) {
    source.fail(
        "the header counts 0 points, but {} bytes follow, room for {} points: the file was not finished "
        "(LAStools' lasinfo -repair counts them again)",
        rest, room);
  }
  if (header.points > 1 && rest % header.points == 0 && rest % header.record_bytes != 0) {
    source.fail("{} bytes are left behind the points, {} a point: records seem to be longer than the header's {} bytes",
                rest, rest / header.points, header.record_bytes);
  }
  const std::string more =
      room == 0 ? "" : fmt::format(", room for {} more points than the header's {}", room, header.points);
  info.warnings.push_back({"bytes_left", fmt::format("{} bytes behind the points are not read{}", rest, more)});
}

PointCloud read_las(ByteSource& source, FileInfo& info, const ReadOptions& options) {
  const LasHeader header = read_las_header(source);
  info.format = fmt::format("LAS 1.{} format {}", header.version_minor, header.point_format);
  LasRecords records = read_las_records(source, header, info);
  source.skip(header.data_offset, "all that comes before the points");
  check_counts(source, header, info);
  read_extended_records(source, header, records, info);
  check_rest(source, header, records, info);

  const CoordinateUnits units = las_units(header, records, info);
  const RecordLayout layout = las_layout(header, meters_per_unit(units, info));
  CloudBuilder builder(source, {true, {layout.columns.color, ScalarType::kUint16}}, header.points);
  LasSelection selection(header, options);
  for_each_block(source, header.points, layout.bytes,
                 [&](const std::byte* data, std::size_t n) { selection.append(data, n, layout, builder); });
  if (header.points > 0) selection.check(source, info);
  PointCloud cloud = builder.finish(info);
  for (const double step_m : layout.columns.scale) cloud.file_step_m = std::max(cloud.file_step_m, std::abs(step_m));
  refuse_degrees(source, units, cloud, info);
  return cloud;
}

}  // namespace

namespace formats {

extern constinit const CloudFormat las{
    .name = "LAS",
    .listed = "LAS",
    .by_content = [](const FileStart& start) { return start.bytes.starts_with("LASF"); },
    .read = read_las,
    .has_classes = true};

}  // namespace formats

}  // namespace cmap
