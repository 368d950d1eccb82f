#include <cmath>
#include <map>
#include <string>

#include "cmap/io/line_reader.hpp"
#include "cmap/io/mesh_file.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

double number(const LineReader& lines, std::string_view token) {
  double value = 0.0;
  if (!parse_number(token, value) || !std::isfinite(value)) lines.fail("'{}' is not a finite number", token);
  return value;
}

/// What is left of a line: a name, which may hold blanks.
std::string name_of(std::string_view rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return std::string(rest);
}

RgbF color_of(const LineReader& lines, std::string_view& rest) {
  RgbF color;
  for (float& channel : color) {
    const double value = number(lines, next_token(rest));
    if (value < 0.0 || value > 1.0) lines.fail("a color of {}: [0,1] expected", value);
    channel = static_cast<float>(value);
  }
  return color;
}

/// Materials by name, numbered in order of appearance.
using MaterialNumbers = std::map<std::string, std::uint32_t, std::less<>>;

void read_materials(const std::filesystem::path& path, MeshFile& mesh, MaterialNumbers& numbers) {
  ByteSource source(path);
  LineReader lines(source);
  std::string_view line;
  MeshMaterial* material = nullptr;
  while (lines.next(line)) {
    std::string_view rest = line;
    const std::string_view keyword = next_token(rest);
    if (keyword == "newmtl") {
      numbers[name_of(rest)] = static_cast<std::uint32_t>(mesh.materials.size());
      material = &mesh.materials.emplace_back();
    } else if (keyword == "Kd" || keyword == "map_Kd") {
      if (material == nullptr) lines.fail("'{}' before any 'newmtl'", keyword);
      if (keyword == "Kd") {
        material->diffuse = color_of(lines, rest);
      } else {
        const std::string name = name_of(rest);
        if (name.empty() || name.front() == '-')
          lines.fail("map_Kd '{}': the name of an image, without options, expected", name);
        material->image = path.parent_path() / name;
      }
    }
  }
}

class ObjReader {
 public:
  ObjReader(ByteSource& source, std::filesystem::path folder) : lines_(source), folder_(std::move(folder)) {
    // Material 0: faces before any usemtl.
    mesh_.materials.emplace_back();
  }

  MeshFile read() {
    std::string_view line;
    while (lines_.next(line)) {
      std::string_view rest = line.substr(0, line.find('#'));
      const std::string_view keyword = next_token(rest);
      if (keyword == "v") {
        read_vertex(rest);
      } else if (keyword == "vt") {
        const double u = number(lines_, next_token(rest)), v = number(lines_, next_token(rest));
        texture_points_.emplace_back(static_cast<float>(u), static_cast<float>(v));
      } else if (keyword == "f") {
        read_face(rest);
      } else if (keyword == "mtllib") {
        read_materials(folder_ / name_of(rest), mesh_, materials_);
      } else if (keyword == "usemtl") {
        use_material(name_of(rest));
      }
    }
    if (!mesh_.colors.empty() && mesh_.colors.size() != mesh_.vertices.size()) {
      lines_.fail("only {} of {} vertices have a color", mesh_.colors.size(), mesh_.vertices.size());
    }
    return std::move(mesh_);
  }

 private:
  struct Corner {
    std::uint32_t vertex;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  };

  void read_vertex(std::string_view rest) {
    Eigen::Vector3d v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = number(lines_, next_token(rest));
    if (!is_usable(v)) lines_.fail("a vertex beyond {} m", kMaxCoordinate_m);
    mesh_.vertices.push_back(v);
    std::string_view first = rest;
    next_token(first);
    std::string_view second = first;
    if (next_token(second).empty()) return;  // nothing, or a weight
    mesh_.colors.push_back(color_of(lines_, rest));
  }

  void read_face(std::string_view rest) {
    std::vector<Corner> corners;
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
      corners.push_back(corner(token));
    }
    if (corners.size() < 3) lines_.fail("a face of {} corners", corners.size());
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const Corner &a = corners[0], &b = corners[k], &c = corners[k + 1];
      mesh_.triangles.push_back({a.vertex, b.vertex, c.vertex});
      mesh_.uv.push_back({a.uv, b.uv, c.uv});
      mesh_.material_of.push_back(material_);
    }
  }

  /// "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal".
  Corner corner(std::string_view token) const {
    const std::size_t slash = token.find('/');
    Corner result;
    result.vertex = static_cast<std::uint32_t>(index(token.substr(0, slash), mesh_.vertices.size(), "vertex"));
    if (slash == std::string_view::npos) return result;
    const std::string_view rest = token.substr(slash + 1);
    const std::string_view texture = rest.substr(0, rest.find('/'));
    if (!texture.empty()) result.uv = texture_points_[index(texture, texture_points_.size(), "texture point")];
    return result;
  }

  /// Counts from 1, or back from the last one.
  std::size_t index(std::string_view token, std::size_t count, std::string_view what) const {
    const double value = number(lines_, token);
    const double from_zero = value < 0.0 ? value + static_cast<double>(count) : value - 1.0;
    if (value != std::floor(value) || from_zero < 0.0 || from_zero >= static_cast<double>(count)) {
      lines_.fail("there is no {} {}; {} so far", what, token, count);
    }
    return static_cast<std::size_t>(from_zero);
  }

  void use_material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found == materials_.end()) lines_.fail("there is no material '{}'", name);
    material_ = found->second;
  }

  LineReader lines_;
  std::filesystem::path folder_;
  MeshFile mesh_;
  std::vector<Eigen::Vector2f> texture_points_;
  MaterialNumbers materials_;
  std::uint32_t material_ = 0;
};

}  // namespace

MeshFile read_obj_mesh(ByteSource& source, const std::filesystem::path& folder) {
  return ObjReader(source, folder).read();
}

}  // namespace cmap
