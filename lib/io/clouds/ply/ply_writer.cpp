#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/row_writer.hpp"

namespace cmap {
namespace {

void check_fields(const PointCloud& cloud, std::span<const PointField> fields) {
  for (const PointField& field : fields) {
    if (field.values.size() != cloud.size()) {
      throw std::invalid_argument(fmt::format("write_ply: field '{}' has {} values for {} points", field.name,
                                              field.values.size(), cloud.size()));
    }
    const bool has_blank = std::any_of(field.name.begin(), field.name.end(), [](unsigned char c) { return c <= ' '; });
    if (field.name.empty() || has_blank) {
      throw std::invalid_argument(fmt::format("write_ply: '{}' cannot name a property", field.name));
    }
  }
}

std::string_view color_type(const Colors& colors) {
  if (std::holds_alternative<Array<Rgb8>>(colors)) return "uchar";
  return std::holds_alternative<Array<Rgb16>>(colors) ? "ushort" : "float";
}

std::string header(const PointCloud& cloud, std::span<const PointField> fields, PlyEncoding encoding, bool wide) {
  std::string text = fmt::format("ply\nformat {} 1.0\ncomment written by cmap\nelement vertex {}\n",
                                 encoding == PlyEncoding::kAscii ? "ascii" : "binary_little_endian", cloud.size());
  for (const char axis : {'x', 'y', 'z'}) text += fmt::format("property {} {}\n", wide ? "double" : "float", axis);
  if (cloud.has_color()) {
    for (const auto* name : {"red", "green", "blue"})
      text += fmt::format("property {} {}\n", color_type(cloud.colors), name);
  }
  for (const PointField& field : fields) text += fmt::format("property float {}\n", field.name);
  return text + "end_header\n";
}

template <bool ascii>
class PlyRows {
 public:
  PlyRows(RowWriter& writer, const PointCloud& cloud, std::span<const PointField> fields, bool wide)
      : writer_(writer), cloud_(cloud), fields_(fields), wide_(wide) {}

  /// `colors` is an array of colors or std::monostate.
  template <class ColorArray>
  void write(const ColorArray& colors) {
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      if (wide_) {
        const Eigen::Vector3d p = cloud_.world(i);
        for (int axis = 0; axis < 3; ++axis) put(p[axis]);
      } else {
        for (int axis = 0; axis < 3; ++axis) put(cloud_.positions[i][axis]);
      }
      if constexpr (!std::is_same_v<ColorArray, std::monostate>) {
        for (const auto channel : colors[i]) put(channel);
      }
      for (const PointField& field : fields_) put(field.values[i]);
      if constexpr (ascii) writer_.end_line();
      writer_.end_row();
    }
  }

 private:
  template <class T>
  void put(T value) {
    if constexpr (ascii) {
      writer_.put_text(value);
    } else {
      writer_.put_binary(value);
    }
  }

  RowWriter& writer_;
  const PointCloud& cloud_;
  std::span<const PointField> fields_;
  bool wide_;
};

}  // namespace

void write_ply(OutputFile& file, const PointCloud& cloud, std::span<const PointField> fields, PlyEncoding encoding) {
  check_fields(cloud, fields);
  const bool wide = cloud.origin != Eigen::Vector3d::Zero();
  file.write(header(cloud, fields, encoding, wide));
  RowWriter writer(file);
  std::visit(
      [&](const auto& colors) {
        if (encoding == PlyEncoding::kAscii) {
          PlyRows<true>(writer, cloud, fields, wide).write(colors);
        } else {
          PlyRows<false>(writer, cloud, fields, wide).write(colors);
        }
      },
      cloud.colors);
  writer.flush();
}

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, std::span<const PointField> fields,
               PlyEncoding encoding) {
  OutputFile file(path);
  write_ply(file, cloud, fields, encoding);
  file.commit();
}

}  // namespace cmap
