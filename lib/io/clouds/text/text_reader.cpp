#include <algorithm>
#include <limits>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/text/text_layout.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// The rows of a file: first those that its start has read, then the rest.
class TextRows {
 public:
  TextRows(LineReader& lines, const TextStart& start) : lines_(lines), start_(start) {}

  /// The next line that is neither blank nor a comment; false at the end.
  bool next(std::string_view& line) {
    if (next_of_start_ < start_.rows.size()) {
      number_ = start_.rows[next_of_start_].number;
      line = start_.rows[next_of_start_++].text;
      return true;
    }
    if (start_.whole) return false;
    do {
      if (!lines_.next(line)) return false;
    } while (is_blank_line(line) || is_comment_line(line));
    number_ = lines_.number();
    return true;
  }
  std::uint64_t number() const { return number_; }

 private:
  LineReader& lines_;
  const TextStart& start_;
  std::size_t next_of_start_ = 0;
  std::uint64_t number_ = 0;
};

class TextParser {
 public:
  TextParser(const ByteSource& source, const RowFormat& format, const TextLayout& layout)
      : source_(source), format_(format), layout_(layout) {}

  /// False for a line that holds one number alone: the count of another block of points.
  bool parse(std::string_view line, std::uint64_t number, RowStage::Row& row) {
    split_row(line, format_.separator, columns_);
    // A separator at the end ends the last column, unless that is the empty one behind it.
    if (columns_.size() + 1 == layout_.columns && columns_.back().empty()) columns_.emplace_back();
    if (columns_.size() == 1 && layout_.columns > 1) return false;
    if (columns_.size() != layout_.columns) {
      source_.fail("line {}: {} columns where {} were expected", number, columns_.size(), layout_.columns);
    }
    for (std::size_t k = 0; k < 3; ++k) row.xyz[k] = value_of(layout_.position[k], number);
    if (layout_.color) {
      for (std::size_t k = 0; k < 3; ++k) row.rgb[k] = color_of((*layout_.color)[k], number);
    }
    return true;
  }

 private:
  /// pandas writes a color that is none as empty cells.
  double color_of(std::size_t column, std::uint64_t number) const {
    return columns_[column].empty() ? std::numeric_limits<double>::quiet_NaN() : value_of(column, number);
  }

  double value_of(std::size_t column, std::uint64_t number) const {
    double value = 0.0;
    if (!parse_column(columns_[column], format_, value)) {
      source_.fail("line {}: column {}: '{}' is not a number", number, column + 1, columns_[column].substr(0, 40));
    }
    return value;
  }

  const ByteSource& source_;
  const RowFormat& format_;
  const TextLayout& layout_;
  std::vector<std::string_view> columns_;
};

/// Holds the counts that a file announces against the rows that follow them.
class BlockCount {
 public:
  BlockCount(const ByteSource& source, std::optional<std::uint64_t> announced)
      : source_(source), announced_(announced) {}

  void add_row() { ++rows_; }
  /// A line within the rows that may be the next block's count.
  void begin(std::string_view line, std::uint64_t line_number) {
    unsigned long long count = 0;
    if (!announced_ || rows_ != *announced_ || !parse_number(next_token(line), count)) {
      source_.fail("line {}: 1 column, but the rows before it have more", line_number);
    }
    announced_ = count;
    rows_ = 0;
  }
  void finish(FileInfo& info) const {
    if (!announced_ || rows_ == *announced_) return;
    if (rows_ < *announced_) {
      source_.fail("truncated: a line announces {} points, but {} follow it", *announced_, rows_);
    }
    info.notes.push_back(fmt::format("a line announces {} points, but {} more follow it; all were read", *announced_,
                                     rows_ - *announced_));
  }

 private:
  const ByteSource& source_;
  std::optional<std::uint64_t> announced_;
  std::uint64_t rows_ = 0;
};

PointCloud read_text(ByteSource& source, FileInfo& info) {
  info.format = "text";
  LineReader lines(source);
  const TextStart start = read_text_start(lines);
  const TextLayout layout = text_layout(source, start, info);
  if (start.format.decimal_comma) info.notes.emplace_back("commas taken as decimal ones");
  const ColorDeclaration color{layout.color ? ColorStorage::kSeparate : ColorStorage::kNone};
  // Each column takes a digit and a separator at least.
  CloudBuilder builder(source, {true, color}, source.size() / (2 * layout.columns) + 1);
  RowStage stage(builder, layout.color.has_value());
  TextParser parser(source, start.format, layout);
  TextRows rows(lines, start);
  BlockCount blocks(source, start.count);
  RowStage::Row row{};
  for (std::string_view line; rows.next(line);) {
    if (!parser.parse(line, rows.number(), row)) {
      blocks.begin(line, rows.number());
      continue;
    }
    stage.add(row);
    blocks.add_row();
  }
  stage.flush();
  blocks.finish(info);
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat text{.name = "text",
                                        .listed = "text and PTS (x y z [r g b])",
                                        .by_name = [](const FileStart& start) { return start.text; },
                                        .read = without_options<read_text>};

}  // namespace formats

}  // namespace cmap
