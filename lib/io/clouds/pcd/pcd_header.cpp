#include "clouds/pcd/pcd_header.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

using Words = std::vector<std::string>;

/// The lines of a header as they were found; what they mean together is decided at DATA.
struct RawHeader {
  Words fields, sizes, types, counts, viewpoint;
  std::optional<std::uint64_t> width, height, points;
};

Words split(std::string_view text) {
  Words words;
  for (std::string_view word = next_token(text); !word.empty(); word = next_token(text)) words.emplace_back(word);
  return words;
}

std::uint64_t header_number(const LineReader& lines, std::string_view word) {
  unsigned long long value = 0;
  if (!parse_number(word, value)) lines.fail("'{}' is not a whole number", word);
  return value;
}

PcdData parse_data(const LineReader& lines, std::string_view word) {
  if (word == "ascii") return PcdData::kAscii;
  if (word == "binary") return PcdData::kBinary;
  if (word == "binary_compressed") return PcdData::kCompressed;
  lines.fail("DATA '{}'; ascii, binary or binary_compressed expected", word);
}

/// Stores one line; false if its keyword is unknown.
bool store_line(const LineReader& lines, std::string_view keyword, std::string_view rest, RawHeader& raw) {
  if (keyword == "FIELDS" || keyword == "COLUMNS") {
    raw.fields = split(rest);
  } else if (keyword == "SIZE") {
    raw.sizes = split(rest);
  } else if (keyword == "TYPE") {
    raw.types = split(rest);
  } else if (keyword == "COUNT") {
    raw.counts = split(rest);
  } else if (keyword == "VIEWPOINT") {
    raw.viewpoint = split(rest);
  } else if (keyword == "WIDTH") {
    raw.width = header_number(lines, next_token(rest));
  } else if (keyword == "HEIGHT") {
    raw.height = header_number(lines, next_token(rest));
  } else if (keyword == "POINTS") {
    raw.points = header_number(lines, next_token(rest));
  } else {
    return keyword == "VERSION";
  }
  return true;
}

std::vector<Field> make_fields(const LineReader& lines, const RawHeader& raw) {
  const std::size_t n = raw.fields.size();
  if (n == 0) lines.fail("the header has no line FIELDS");
  const auto same_length = [&](const Words& words, std::string_view keyword) {
    if (words.size() != n) lines.fail("the header has {} values of {} for {} FIELDS", words.size(), keyword, n);
  };
  same_length(raw.sizes, "SIZE");
  same_length(raw.types, "TYPE");
  if (!raw.counts.empty()) same_length(raw.counts, "COUNT");
  std::vector<Field> fields(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t bytes = header_number(lines, raw.sizes[i]);
    const auto type = raw.types[i].size() == 1 ? scalar_from_pcd(raw.types[i][0], bytes) : std::nullopt;
    if (!type) lines.fail("the field '{}' has unknown TYPE {} of SIZE {}", raw.fields[i], raw.types[i], raw.sizes[i]);
    const std::uint64_t count = raw.counts.empty() ? 1 : header_number(lines, raw.counts[i]);
    // COUNT 0 occurs for fields that only pad.
    if (count > ByteSource::kMaxRecordBytes) {
      lines.fail("the field '{}' has COUNT {}; at most {} expected", raw.fields[i], count, ByteSource::kMaxRecordBytes);
    }
    fields[i] = {raw.fields[i], *type, static_cast<std::size_t>(count), std::nullopt};
  }
  return fields;
}

std::uint64_t count_points(const LineReader& lines, const RawHeader& raw) {
  if (!raw.width || !raw.height) {
    if (!raw.points) lines.fail("the header has neither POINTS nor WIDTH and HEIGHT");
    return *raw.points;
  }
  std::uint64_t product = 0;
  if (__builtin_mul_overflow(*raw.width, *raw.height, &product) || product != raw.points.value_or(product)) {
    lines.fail("WIDTH {} times HEIGHT {} is not POINTS {}", *raw.width, *raw.height, raw.points.value_or(0));
  }
  return product;
}

/// VIEWPOINT is where the sensor was (tx ty tz qw qx qy qz); the points are not moved by it.
void keep_viewpoint(const RawHeader& raw, FileInfo& info) {
  constexpr double kIdentity[] = {0, 0, 0, 1, 0, 0, 0};
  if (raw.viewpoint.empty()) return;
  std::array<double, 7> values{};
  bool good = raw.viewpoint.size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) good = parse_number(raw.viewpoint[i], values[i]);
  if (!good || !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    info.notes.emplace_back("VIEWPOINT is no pose and was ignored");
  } else if (!std::equal(values.begin(), values.end(), kIdentity)) {
    info.sensor_positions.emplace_back(values[0], values[1], values[2]);
    info.notes.emplace_back(
        "VIEWPOINT is not the identity: kept as the sensor's position; it does not move the points");
  }
}

}  // namespace

PcdHeader read_pcd_header(LineReader& lines, FileInfo& info) {
  RawHeader raw;
  PcdHeader header;
  std::string_view line;
  for (;;) {
    if (!lines.next(line)) lines.fail("truncated: the file ends before the line DATA");
    std::string_view rest = line;
    const std::string_view keyword = next_token(rest);
    if (keyword.empty() || keyword.front() == '#') continue;
    if (keyword == "DATA") {
      header.data = parse_data(lines, next_token(rest));
      break;
    }
    if (!store_line(lines, keyword, rest, raw)) lines.fail("unknown PCD keyword '{}'", keyword.substr(0, 40));
  }
  header.fields = make_fields(lines, raw);
  header.points = count_points(lines, raw);
  keep_viewpoint(raw, info);
  return header;
}

}  // namespace cmap
