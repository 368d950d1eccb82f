#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

#include "clouds/ply/ply_header.hpp"
#include "cmap/io/mesh_file.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// The numbers of a PLY body one after the other, whatever the encoding.
class PlyNumbers {
 public:
  PlyNumbers(LineReader& lines, PlyFormat format) : lines_(lines), source_(lines.source()), format_(format) {}

  /// A row starts: in ascii, a line that is not blank.
  void begin_row(const PlyElement& element) {
    what_ = "element '" + element.name + "'";
    if (format_ != PlyFormat::kAscii) return;
    do {
      if (!lines_.next(line_)) lines_.fail("truncated: the file ends within {}", what_);
    } while (line_.find_first_not_of(" \t") == std::string_view::npos);
  }

  double next(ScalarType type) {
    if (format_ != PlyFormat::kAscii) return next_binary(type);
    const std::string_view token = next_token(line_);
    double value = 0.0;
    if (!parse_number(token, value)) fail("'{}' in {} is not a number", token, what_);
    return value;
  }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    const std::string text = fmt::format(reason, std::forward<Args>(args)...);
    if (format_ == PlyFormat::kAscii) lines_.fail("{}", text);
    source_.fail("byte {}: {}", source_.position(), text);
  }

 private:
  double next_binary(ScalarType type) {
    return visit_scalar(type, [&](auto value) {
      std::array<std::byte, sizeof(value)> bytes;
      source_.read(bytes, what_);
      const bool is_big = std::endian::native == std::endian::big;
      if ((format_ == PlyFormat::kBigEndian) != is_big) std::reverse(bytes.begin(), bytes.end());
      std::memcpy(&value, bytes.data(), sizeof(value));
      return static_cast<double>(value);
    });
  }

  LineReader& lines_;
  ByteSource& source_;
  PlyFormat format_;
  std::string_view line_;
  std::string what_;
};

/// Where a vertex' members lie among its properties.
struct VertexLayout {
  std::array<std::size_t, 3> position{};
  std::optional<std::array<std::size_t, 3>> color;
  double color_scale = 1.0;  ///< to [0,1]
};

std::optional<std::size_t> find(const PlyElement& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].name == name && element.properties[i].is_scalar()) return i;
  }
  return std::nullopt;
}

VertexLayout vertex_layout(const ByteSource& source, const PlyElement& vertex) {
  VertexLayout layout;
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = find(vertex, kAxes[axis]);
    if (!found) source.fail("header: the vertices have no property '{}'", kAxes[axis]);
    layout.position[axis] = *found;
  }
  for (const std::string prefix : {"", "diffuse_"}) {
    const auto r = find(vertex, prefix + "red"), g = find(vertex, prefix + "green"), b = find(vertex, prefix + "blue");
    if (!r || !g || !b) continue;
    const ScalarType type = vertex.properties[*r].type;
    if (!is_floating(type) && type != ScalarType::kUint8 && type != ScalarType::kUint16) {
      source.fail("header: colors of type {}; uchar, ushort or float expected", scalar_name(type));
    }
    layout.color = {*r, *g, *b};
    layout.color_scale = is_floating(type) ? 1.0 : 1.0 / scalar_max(type);
    break;
  }
  return layout;
}

std::size_t list_length(const PlyNumbers& numbers, double length) {
  if (!(length >= 0.0 && length <= 65535.0 && length == std::floor(length))) {
    numbers.fail("a list of length {}", length);
  }
  return static_cast<std::size_t>(length);
}

void read_vertices(PlyNumbers& numbers, const ByteSource& source, const PlyElement& element, MeshFile& mesh) {
  const VertexLayout layout = vertex_layout(source, element);
  std::vector<double> row(element.properties.size());
  for (std::uint64_t i = 0; i < element.count; ++i) {
    numbers.begin_row(element);
    for (std::size_t k = 0; k < row.size(); ++k) {
      const Field& field = element.properties[k];
      if (field.list_count_type) {
        for (std::size_t n = list_length(numbers, numbers.next(*field.list_count_type)); n > 0; --n) {
          numbers.next(field.type);
        }
      } else {
        row[k] = numbers.next(field.type);
      }
    }
    mesh.vertices.emplace_back(row[layout.position[0]], row[layout.position[1]], row[layout.position[2]]);
    if (!is_usable(mesh.vertices.back())) numbers.fail("vertex {} is not finite, or beyond {} m", i, kMaxCoordinate_m);
    if (!layout.color) continue;
    RgbF color;
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<float>(layout.color_scale * row[(*layout.color)[c]]);
    if (!std::all_of(color.begin(), color.end(), [](float v) { return v >= 0.0F && v <= 1.0F; })) {
      numbers.fail("vertex {}: a color outside of [0,1]", i);
    }
    mesh.colors.push_back(color);
  }
}

void read_faces(PlyNumbers& numbers, const PlyElement& element, std::uint64_t vertex_count, MeshFile& mesh) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    numbers.begin_row(element);
    for (const Field& field : element.properties) {
      const bool is_corners = field.name == "vertex_indices" || field.name == "vertex_index";
      const std::size_t n = field.list_count_type ? list_length(numbers, numbers.next(*field.list_count_type)) : 1;
      std::vector<std::uint32_t> corners;
      for (std::size_t k = 0; k < n; ++k) {
        const double value = numbers.next(field.type);
        if (!is_corners) continue;
        if (!(value >= 0.0 && value < static_cast<double>(vertex_count) && value == std::floor(value))) {
          numbers.fail("face {}: there is no vertex {}", i, value);
        }
        corners.push_back(static_cast<std::uint32_t>(value));
      }
      if (!is_corners) continue;
      if (corners.size() < 3) numbers.fail("face {} has {} corners", i, corners.size());
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
      }
    }
  }
}

void skip_rows(PlyNumbers& numbers, const PlyElement& element) {
  for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
    numbers.begin_row(element);
    for (const Field& field : element.properties) {
      const std::size_t n = field.list_count_type ? list_length(numbers, numbers.next(*field.list_count_type)) : 1;
      for (std::size_t k = 0; k < n; ++k) numbers.next(field.type);
    }
  }
}

}  // namespace

bool is_usable(const Eigen::Vector3d& vertex) {
  return vertex.allFinite() && vertex.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

MeshFile read_ply_mesh(ByteSource& source) {
  LineReader lines(source);
  const PlyHeader header = read_ply_header(lines);
  PlyNumbers numbers(lines, header.format);
  MeshFile mesh;
  const std::uint64_t vertex_count = header.elements[header.vertex].count;
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    if (e == header.vertex) {
      read_vertices(numbers, source, element, mesh);
    } else if (element.name == "face") {
      read_faces(numbers, element, vertex_count, mesh);
    } else {
      skip_rows(numbers, element);
    }
  }
  return mesh;
}

}  // namespace cmap
