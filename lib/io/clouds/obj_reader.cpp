#include <algorithm>
#include <array>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// A line "v x y z [w] [r g b]": the numbers after v.
struct Vertex {
  std::array<double, 7> values{};
  std::size_t n = 0;
  bool colored() const { return n >= 6; }
};

Vertex parse_vertex(const LineReader& lines, std::string_view rest) {
  Vertex vertex;
  for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
    if (vertex.n == vertex.values.size()) lines.fail("a vertex of more than 7 numbers (x y z w r g b)");
    if (!parse_number(token, vertex.values[vertex.n])) lines.fail("'{}' is not a number", token.substr(0, 40));
    ++vertex.n;
  }
  if (vertex.n < 3 || vertex.n == 5) lines.fail("a vertex of {} numbers; x y z [w] [r g b] expected", vertex.n);
  return vertex;
}

RowStage::Row row_of(const Vertex& vertex) {
  RowStage::Row row{};
  std::copy_n(vertex.values.begin(), 3, row.xyz.begin());
  const std::size_t color = vertex.n - 3;
  if (vertex.colored()) std::copy_n(&vertex.values[color], 3, row.rgb.begin());
  return row;
}

/// The vertex lines of a file, which all have the same numbers.
class VertexLines {
 public:
  explicit VertexLines(LineReader& lines) : lines_(lines) {}

  /// False at the end of the file. Throws InputError at the first face.
  bool next(Vertex& vertex) {
    for (std::string_view line; lines_.next(line);) {
      const std::string_view keyword = next_token(line);
      if (keyword == "f" || keyword == "fo") {
        lines_.source().fail(
            "is a mesh (OBJ; line {} holds the first face), not a point cloud; sample points on its surface first "
            "(CloudCompare and Open3D do)",
            lines_.number());
      }
      if (keyword == "curv" || keyword == "surf") lines_.source().fail("holds free-form surfaces, not points");
      if (keyword != "v") continue;
      vertex = parse_vertex(lines_, line);
      if (n_values_ == 0) n_values_ = vertex.n;
      if (vertex.n != n_values_) {
        lines_.fail("a vertex of {} numbers where the first one has {}", vertex.n, n_values_);
      }
      return true;
    }
    return false;
  }

 private:
  LineReader& lines_;
  std::size_t n_values_ = 0;
};

bool is_vertex(std::string_view line) {
  const auto tokens = tokens_of(line, 4);
  std::vector<double> values;
  return tokens.size() == 4 && tokens[0] == "v" && parse_numbers({tokens.begin() + 1, tokens.end()}, values);
}

bool is_obj(const FileStart& start) {
  if (!start.text) return false;
  if (start.extension == ".obj") return true;
  for (const std::string_view line : start.lines(100)) {
    const auto tokens = tokens_of(line, 1);
    if (tokens.empty() || tokens[0].starts_with('#')) continue;
    if (is_vertex(line)) return true;
    if (tokens[0] != "mtllib" && tokens[0] != "o" && tokens[0] != "g" && tokens[0] != "vn") return false;
  }
  return false;
}

PointCloud read_obj_points(ByteSource& source, FileInfo& info) {
  info.format = "OBJ points";
  LineReader lines(source);
  VertexLines vertices(lines);
  Vertex vertex;
  if (!vertices.next(vertex)) source.fail("an OBJ file without a vertex ('v x y z')");
  const ColorStorage color = vertex.colored() ? ColorStorage::kSeparate : ColorStorage::kNone;
  // Each of the numbers takes a digit and a separator at least, and so does 'v'.
  CloudBuilder builder(source, {true, {color}}, source.size() / (2 * vertex.n + 2) + 1);
  RowStage stage(builder, vertex.colored());
  if (vertex.n == 4 || vertex.n == 7) info.notes.emplace_back("the vertices' fourth number (a weight) is not used");
  do {
    stage.add(row_of(vertex));
  } while (vertices.next(vertex));
  stage.flush();
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat obj{
    .name = "OBJ", .listed = "OBJ without faces", .by_content = is_obj, .read = without_options<read_obj_points>};

}  // namespace formats

}  // namespace cmap
