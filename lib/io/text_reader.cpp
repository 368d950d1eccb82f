#include <algorithm>
#include <cmath>

#include "io/ascii_rows.hpp"
#include "io/format_readers.hpp"
#include "io/number_text.hpp"
#include "io/text_layout.hpp"

namespace cmap {
namespace {

/// Decides over a whole file whether its colors are 0..255 or [0,1]: by whether any value is above 1.
class ColorScale {
 public:
  /// Takes note of one value. Throws InputError if it fits neither scale.
  void see(const LineReader& lines, double value) {
    if (!std::isfinite(value)) return;  // the point will be dropped
    if (value < 0.0 || value > 255.0) {
      lines.fail("color {:g}; 0 to 255 or 0 to 1 expected (if these columns are no colors, name them in a header line)",
                 value);
    }
    if (value > 1.0 && above_one_ == 0) above_one_ = lines.number();
    if (value != std::trunc(value) && fraction_ == 0) fraction_ = lines.number();
  }

  /// Turns 0..255 into Rgb8 and leaves [0,1] as it is.
  void apply(const ByteSource& source, Colors& colors, FileInfo& info) const {
    if (above_one_ == 0) {
      info.notes.emplace_back("colors taken as [0,1]: no value above 1");
      return;
    }
    if (fraction_ > 0) {
      source.fail("line {} has a color above 1 and line {} a fraction: neither 0 to 255 nor 0 to 1", above_one_,
                  fraction_);
    }
    info.notes.emplace_back("colors taken as 0 to 255: values above 1");
    const auto& wide = std::get<Array<RgbF>>(colors);
    Array<Rgb8> narrow(wide.size());
    std::transform(wide.begin(), wide.end(), narrow.begin(), [](const RgbF& color) {
      return Rgb8{static_cast<std::uint8_t>(color[0]), static_cast<std::uint8_t>(color[1]),
                  static_cast<std::uint8_t>(color[2])};
    });
    colors = std::move(narrow);
  }

 private:
  std::uint64_t above_one_ = 0;  // lines; 0: none so far
  std::uint64_t fraction_ = 0;
};

/// The first line of numbers, and the names of the columns if a line before it has them.
struct Start {
  std::vector<std::string> names;
  std::string_view line;
};

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

bool is_empty(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return is_blank(c); });
}

std::string_view without_comment_mark(std::string_view line) {
  return line.substr(std::min(line.size(), line.find_first_not_of("#/")));
}

std::string_view without_byte_order_mark(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  return line;
}

Start find_start(LineReader& lines) {
  Start start;
  bool has_header = false;
  std::vector<std::string> comment;
  while (lines.next(start.line)) {
    if (lines.number() == 1) start.line = without_byte_order_mark(start.line);
    if (is_empty(start.line)) continue;
    if (is_comment(start.line)) {
      std::vector<std::string> names = split_columns(without_comment_mark(start.line));
      if (names_axes(names)) comment = std::move(names);
      continue;
    }
    std::vector<std::string> columns = split_columns(start.line);
    double number = 0.0;
    if (parse_number(columns.front(), number)) {
      if (!has_header && comment.size() == columns.size()) start.names = std::move(comment);
      return start;
    }
    if (has_header) {
      lines.fail("'{}' is not a number (taken for text, x y z [r g b], as no other format was recognized)",
                 columns.front().substr(0, 40));
    }
    start.names = std::move(columns);
    has_header = true;
  }
  lines.source().fail("holds no line of numbers");
}

class TextParser {
 public:
  TextParser(const LineReader& lines, const TextLayout& layout) : lines_(lines), layout_(layout) {}

  RowStage::Row parse(std::string_view line) {
    columns_.clear();
    for (std::string_view column; next_column(line, column);) columns_.push_back(column);
    if (columns_.size() != layout_.columns) {
      lines_.fail("{} columns where {} were expected", columns_.size(), layout_.columns);
    }
    RowStage::Row row{};
    for (std::size_t k = 0; k < 3; ++k) row.xyz[k] = number(layout_.position[k]);
    if (layout_.color) {
      for (std::size_t k = 0; k < 3; ++k) {
        row.rgb[k] = number((*layout_.color)[k]);
        scale_.see(lines_, row.rgb[k]);
      }
    }
    return row;
  }

  const ColorScale& scale() const { return scale_; }

 private:
  double number(std::size_t column) const {
    double value = 0.0;
    if (!parse_number(columns_[column], value)) {
      lines_.fail("column {}: '{}' is not a number", column + 1, columns_[column].substr(0, 40));
    }
    return value;
  }

  const LineReader& lines_;
  const TextLayout& layout_;
  std::vector<std::string_view> columns_;
  ColorScale scale_;
};

}  // namespace

PointCloud read_text(ByteSource& source, FileInfo& info) {
  info.format = "text";
  LineReader lines(source);
  const Start start = find_start(lines);
  const TextLayout layout = text_layout(lines, start.names, start.line, info);
  const ColorStorage color = layout.color ? ColorStorage::kAnyFloat : ColorStorage::kNone;
  // Each column takes a digit and a separator at least.
  CloudBuilder builder(source, {true, color, {"red", "green", "blue"}}, source.size() / (2 * layout.columns) + 1);
  RowStage stage(builder, color);
  TextParser parser(lines, layout);
  std::string_view line = start.line;
  do {
    if (!is_empty(line) && !is_comment(line)) stage.add(parser.parse(line));
  } while (lines.next(line));
  stage.flush();
  PointCloud cloud = builder.finish(info);
  if (layout.color) parser.scale().apply(source, cloud.colors, info);
  return cloud;
}

}  // namespace cmap
