#include "clouds/ply/ply_rest.hpp"

#include <algorithm>

#include "bytes/ascii_rows.hpp"
#include "clouds/ply/ply_rows.hpp"
#include "clouds/point_names.hpp"
#include "clouds/record_reader.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

bool holds_faces(const PlyElement& element) {
  return element.count > 0 && (element.name == "face" || element.name == "faces" || element.name == "tristrips");
}

bool has_color(const PlyElement& element) {
  std::vector<std::string> names;
  for (const Field& field : element.properties) names.push_back(field.name);
  return find_point_names(names).color.has_value();
}

void say_what_is_not_used(const PlyHeader& header, FileInfo& info) {
  const PlyElement& vertex = header.elements[header.vertex];
  std::vector<std::string> others;
  for (const PlyElement& element : header.elements) {
    if (&element == &vertex || element.count == 0) continue;
    if (!holds_faces(element)) {
      others.push_back(element.name);
      continue;
    }
    info.warnings.push_back(
        {"mesh_read_as_points", fmt::format("is a mesh of {} faces ({}); only its {} vertices are compared, not its "
                                            "surface: sample points on the surface first",
                                            element.count, element.name, vertex.count)});
    if (has_color(element) && !has_color(vertex)) {
      info.warnings.push_back(
          {"colors_in_faces", "no color: only the faces of the mesh have colors, its vertices none"});
    }
  }
  note_unused(others, "elements", info);
}

void warn_of_cut(const PlyElement& element, std::uint64_t rows, FileInfo& info) {
  info.warnings.push_back({"file_incomplete", fmt::format("the file ends early, after {} of {} rows of '{}': is it an "
                                                          "interrupted copy? Its points are all there",
                                                          rows, element.count, element.name)});
}

/// Whether a row holds as many numbers as its lists announce.
bool is_whole_row(std::string_view row, const PlyElement& element) {
  for (const Field& field : element.properties) {
    double n = 1.0;
    std::string_view token = next_token(row);
    if (token.empty()) return false;
    if (!field.list_count_type) continue;
    if (!parse_number(token, n)) return true;  // not ours to judge
    for (; n > 0.0; --n) {
      token = next_token(row);
      if (token.empty()) return false;
    }
  }
  return true;
}

/// False where the file ends within the element.
bool pass_ascii(LineReader& lines, const PlyElement& element, FileInfo& info) {
  if (element.properties.empty()) return true;
  std::string_view line;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    do {
      if (lines.next(line)) continue;
      warn_of_cut(element, i, info);
      return false;
    } while (without_blanks(line).empty());
  }
  if (element.count == 0 || is_whole_row(line, element)) return true;
  warn_of_cut(element, element.count - 1, info);
  return false;
}

bool pass_lists(ByteSource& source, const PlyElement& element, bool swap_bytes, FileInfo& info) {
  PlyRowWalker walker(source, element, swap_bytes);
  std::uint64_t row = 0;
  try {
    for (; row < element.count; ++row) walker.next(nullptr);
  } catch (const InputError&) {
    warn_of_cut(element, row, info);
    return false;
  }
  return true;
}

bool pass_binary(ByteSource& source, const PlyElement& element, bool swap_bytes, FileInfo& info) {
  if (element.properties.empty() || element.count == 0) return true;
  if (element.has_lists()) return pass_lists(source, element, swap_bytes, info);
  const std::uint64_t bytes = element.row_bytes();
  if (element.count > source.remaining() / bytes) {
    source.fail("truncated: {} rows of element '{}' from byte {} on do not fit into {} bytes", element.count,
                element.name, source.position(), source.size());
  }
  source.skip(element.count * bytes, "element '" + element.name + "'");
  return true;
}

/// Editors and some writers end even a binary file with a line end.
bool is_line_end(ByteSource& source) {
  if (source.remaining() > 2) return false;
  const auto bytes = source.peek(source.remaining());
  return std::all_of(bytes.begin(), bytes.end(),
                     [](std::byte b) { return b == std::byte{'\n'} || b == std::byte{'\r'}; });
}

void check_bytes_left_over(ByteSource& source, const PlyHeader& header, FileInfo& info) {
  const std::uint64_t n = source.remaining();
  if (n == 0 || is_line_end(source)) return;
  const bool fixed = std::none_of(header.elements.begin(), header.elements.end(),
                                  [](const PlyElement& element) { return element.count > 0 && element.has_lists(); });
  const PlyElement& vertex = header.elements[header.vertex];
  if (fixed) refuse_bytes_left_over(source, n, vertex.count);
  info.notes.push_back(fmt::format("{} bytes are left over after all that the header says; not read", n));
}

}  // namespace

void check_ply_rest(LineReader& lines, const PlyHeader& header, bool swap_bytes, FileInfo& info) {
  say_what_is_not_used(header, info);
  const bool ascii = header.format == PlyFormat::kAscii;
  for (std::size_t e = header.vertex + 1; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    const bool whole =
        ascii ? pass_ascii(lines, element, info) : pass_binary(lines.source(), element, swap_bytes, info);
    if (!whole) return;
  }
  if (ascii) {
    note_lines_left_over(lines, info);
  } else {
    check_bytes_left_over(lines.source(), header, info);
  }
}

}  // namespace cmap
