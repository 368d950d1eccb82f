#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/row_writer.hpp"
#include "containers/lzf_codec.hpp"

namespace cmap {
namespace {

/// 0x00RRGGBB. No alpha: with it the float would be a NaN, whose bits not every program leaves alone.
std::uint32_t packed_rgb(const Colors& colors, std::size_t i) {
  const RgbF rgb = rgb_255(colors, i);
  std::uint32_t packed = 0;
  for (const float channel : rgb) packed = packed << 8 | static_cast<std::uint32_t>(std::lround(channel));
  return packed;
}

std::string header(const PointCloud& cloud, PcdEncoding encoding) {
  const bool wide = cloud.origin != Eigen::Vector3d::Zero();
  const bool ascii = encoding == PcdEncoding::kAscii;
  const int bytes = wide ? 8 : 4;
  const auto color = [&](std::string_view text) { return cloud.has_color() ? text : std::string_view(); };
  // In text, as PCL does, the packed color is an integer: as a float it would lose bits.
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{}\nSIZE {} {} {}{}\nTYPE F F F{}\n"
      "COUNT 1 1 1{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      color(" rgb"), bytes, bytes, bytes, color(" 4"), color(ascii ? " U" : " F"), color(" 1"), cloud.size(),
      cloud.size(),
      ascii                              ? "ascii"
      : encoding == PcdEncoding::kBinary ? "binary"
                                         : "binary_compressed");
}

/// Calls put(value) for a coordinate of point i, as float or double.
template <class Put>
void put_coordinate(const PointCloud& cloud, std::size_t i, int axis, Put&& put) {
  if (cloud.origin == Eigen::Vector3d::Zero()) {
    put(cloud.positions[i][axis]);
  } else {
    put(cloud.origin[axis] + static_cast<double>(cloud.positions[i][axis]));
  }
}

void write_rows(OutputFile& file, const PointCloud& cloud, bool ascii) {
  RowWriter writer(file);
  const auto put = [&](auto value) { ascii ? writer.put_text(value) : writer.put_binary(value); };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) put_coordinate(cloud, i, axis, put);
    if (cloud.has_color()) put(packed_rgb(cloud.colors, i));
    if (ascii) writer.end_line();
    writer.end_row();
  }
  writer.flush();
}

/// The body of a compressed file: field by field, each with all its points.
Array<std::byte> column_body(const PointCloud& cloud) {
  const std::size_t coordinate_bytes = cloud.origin == Eigen::Vector3d::Zero() ? sizeof(float) : sizeof(double);
  Array<std::byte> body(cloud.size() * (3 * coordinate_bytes + (cloud.has_color() ? sizeof(std::uint32_t) : 0)));
  std::byte* out = body.data();
  const auto put = [&]<class T>(T value) {
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < cloud.size(); ++i) put_coordinate(cloud, i, axis, put);
  }
  if (cloud.has_color()) {
    for (std::size_t i = 0; i < cloud.size(); ++i) put(packed_rgb(cloud.colors, i));
  }
  return body;
}

void write_compressed(OutputFile& file, const PointCloud& cloud) {
  const Array<std::byte> body = column_body(cloud);
  const Array<std::byte> compressed = lzf_shrink(body);
  if (compressed.empty() && !body.empty()) {
    throw UsageError("a compressed PCD cannot hold this many points (4 GiB at most); choose binary");
  }
  for (const std::size_t size : {compressed.size(), body.size()}) {
    const auto narrow = static_cast<std::uint32_t>(size);
    file.write(&narrow, sizeof(narrow));
  }
  file.write(compressed.data(), compressed.size());
}

}  // namespace

void write_pcd(OutputFile& file, const PointCloud& cloud, PcdEncoding encoding) {
  file.write(header(cloud, encoding));
  if (encoding == PcdEncoding::kBinaryCompressed) {
    write_compressed(file, cloud);
  } else {
    write_rows(file, cloud, encoding == PcdEncoding::kAscii);
  }
}

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, PcdEncoding encoding) {
  OutputFile file(path);
  write_pcd(file, cloud, encoding);
  file.commit();
}

}  // namespace cmap
