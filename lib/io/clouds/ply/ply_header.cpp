#include "clouds/ply/ply_header.hpp"

#include <algorithm>

#include "clouds/foreign_formats.hpp"
#include "clouds/point_names.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

PlyFormat parse_format(const LineReader& lines, std::string_view rest) {
  const std::string_view name = next_token(rest);
  const std::string_view version = next_token(rest);
  if (version != "1.0") lines.fail("PLY version '{}'; 1.0 expected", version);
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  lines.fail("PLY format '{}'; ascii, binary_little_endian or binary_big_endian expected", name);
}

PlyElement parse_element(const LineReader& lines, std::string_view rest) {
  PlyElement element;
  element.name = next_token(rest);
  const std::string_view token = next_token(rest);
  unsigned long long count = 0;
  if (element.name.empty() || !parse_number(token, count)) {
    lines.fail("'{}' is not the number of elements '{}'", token, element.name);
  }
  element.count = count;
  return element;
}

ScalarType parse_type(const LineReader& lines, const PlyElement& element, std::string_view token) {
  const auto type = scalar_from_ply_name(token);
  if (!type) lines.fail("unknown property type '{}' in element '{}'", token, element.name);
  return *type;
}

Field parse_property(const LineReader& lines, const PlyElement& element, std::string_view rest) {
  Field field;
  std::string_view token = next_token(rest);
  if (token == "list") {
    field.list_count_type = parse_type(lines, element, next_token(rest));
    if (is_floating(*field.list_count_type)) lines.fail("the length of a list cannot be a floating-point number");
    token = next_token(rest);
  }
  field.type = parse_type(lines, element, token);
  field.name = next_token(rest);
  if (field.name.empty()) lines.fail("a property without a name");
  return field;
}

std::vector<std::string> property_names(const PlyElement& element) {
  std::vector<std::string> names;
  for (const Field& field : element.properties) names.push_back(field.name);
  return names;
}

void refuse_splats(const ByteSource& source, const PlyElement& element) {
  if (element.name == "chunk" || names_splats(property_names(element))) source.fail("{}", splat_hint());
}

std::size_t find_vertex(const ByteSource& source, const std::vector<PlyElement>& elements) {
  const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
  for (const PlyElement& element : elements) refuse_splats(source, element);
  const auto found = std::find_if(elements.begin(), elements.end(), is_vertex);
  if (found == elements.end()) source.fail("header: no element 'vertex'");
  if (std::find_if(found + 1, elements.end(), is_vertex) != elements.end()) {
    source.fail("header: the element 'vertex' is declared twice");
  }
  return static_cast<std::size_t>(found - elements.begin());
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const Field& f) { return f.list_count_type.has_value(); });
}

std::uint64_t PlyElement::row_bytes() const {
  std::uint64_t bytes = 0;
  for (const Field& field : properties) bytes += scalar_bytes(field.type);
  return bytes;
}

PlyHeader read_ply_header(LineReader& lines) {
  PlyHeader header;
  bool has_format = false;
  std::string_view line;
  if (!lines.next(line) || next_token(line) != "ply") lines.fail("a PLY file starts with the line 'ply'");
  for (;;) {
    if (!lines.next(line)) lines.fail("truncated: the file ends before 'end_header'");
    std::string_view rest = line;
    const std::string_view keyword = next_token(rest);
    if (keyword == "end_header") break;
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      header.format = parse_format(lines, rest);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(lines, rest));
    } else if (keyword == "property") {
      if (header.elements.empty()) lines.fail("a property before any element");
      PlyElement& element = header.elements.back();
      element.properties.push_back(parse_property(lines, element, rest));
    } else {
      lines.fail("unknown PLY keyword '{}'", keyword.substr(0, 40));
    }
  }
  if (!has_format) lines.fail("the header ends without a line 'format'");
  header.vertex = find_vertex(lines.source(), header.elements);
  return header;
}

}  // namespace cmap
