#include "bytes/ascii_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// What a field's value is for.
enum class Target { kSkip, kX, kY, kZ, kRed, kGreen, kBlue, kPacked };

std::vector<Target> field_targets(std::span<const Field> fields, const PointSchema& schema) {
  std::vector<Target> targets(fields.size(), Target::kSkip);
  constexpr std::array kAxes{Target::kX, Target::kY, Target::kZ};
  constexpr std::array kChannels{Target::kRed, Target::kGreen, Target::kBlue};
  for (std::size_t k = 0; k < 3; ++k) {
    targets[schema.position[k]] = kAxes[k];
    if (schema.layout.color.storage == ColorStorage::kNone) continue;
    if (schema.layout.color.storage == ColorStorage::kPacked) {
      targets[schema.color_fields[0]] = Target::kPacked;
    } else {
      targets[schema.color_fields[k]] = kChannels[k];
    }
  }
  return targets;
}

/// Reads the values of one line.
class RowParser {
 public:
  RowParser(const LineReader& lines, std::span<const Field> fields, const PointSchema& schema)
      : lines_(lines), fields_(fields), targets_(field_targets(fields, schema)) {}

  RowStage::Row parse(std::string_view line) {
    RowStage::Row row{};
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const Field& field = fields_[i];
      if (targets_[i] == Target::kSkip) {
        skip(field, line);
      } else {
        store(field, targets_[i], token_of(field, line), row);
      }
    }
    if (const auto extra = next_token(line); !extra.empty())
      lines_.fail("'{}' follows the last of the point's values", extra);
    return row;
  }

  const PackedFloats& packed() const { return packed_; }

 private:
  std::string_view token_of(const Field& field, std::string_view& line) const {
    const std::string_view token = next_token(line);
    if (token.empty()) lines_.fail("ends before the value of '{}'", field.name);
    return token;
  }

  void skip(const Field& field, std::string_view& line) const {
    unsigned long long count = field.count;
    if (field.list_count_type) {
      const std::string_view token = token_of(field, line);
      if (!parse_number(token, count)) lines_.fail("'{}': '{}' is not the length of a list", field.name, token);
    }
    for (; count > 0; --count) token_of(field, line);
  }

  void store(const Field& field, Target target, std::string_view token, RowStage::Row& row) {
    switch (target) {
      case Target::kSkip:
        break;
      case Target::kX:
      case Target::kY:
      case Target::kZ:
        row.xyz[index(target, Target::kX)] = number(field, token);
        break;
      case Target::kRed:
      case Target::kGreen:
      case Target::kBlue:
        row.rgb[index(target, Target::kRed)] = number(field, token);
        break;
      case Target::kPacked:
        unpack(field, token, row);
        break;
    }
  }

  static std::size_t index(Target target, Target first) {
    return static_cast<std::size_t>(target) - static_cast<std::size_t>(first);
  }

  /// The value as a binary file of the same type would hold it.
  double number(const Field& field, std::string_view token) const {
    bool good = false;
    double value = 0.0;
    if (field.type == ScalarType::kFloat32) {
      float narrow = 0.0F;
      good = parse_number(token, narrow);
      value = static_cast<double>(narrow);
    } else {
      good = parse_number(token, value);
    }
    if (!good) lines_.fail("'{}': '{}' is not a number", field.name, token);
    if (!is_floating(field.type) &&
        !(value == std::trunc(value) && value >= scalar_min(field.type) && value <= scalar_max(field.type))) {
      lines_.fail("'{}': '{}' is not of type {}", field.name, token, scalar_name(field.type));
    }
    return value;
  }

  /// A packed color is the integer 0x..RRGGBB, or the float with these bits (then never a whole number but 0). Written
  /// as "nan", whatever its bits were, it is lost.
  void unpack(const Field& field, std::string_view token, RowStage::Row& row) {
    const bool is_float = field.type == ScalarType::kFloat32;
    std::uint32_t bits = 0;
    if (is_float && !is_exact_integer(token)) {
      float value = 0.0F;
      if (!parse_number(token, value)) lines_.fail("'{}': '{}' is not a number", field.name, token);
      if (std::isnan(value)) return row.rgb.fill(std::numeric_limits<double>::quiet_NaN());
      packed_.add_printed(token, value);
      bits = std::bit_cast<std::uint32_t>(value);
    } else {
      double value = 0.0;
      if (!parse_number(token, value) || value != std::trunc(value) || std::abs(value) > 4294967295.0) {
        lines_.fail("'{}': '{}' is not a packed color", field.name, token);
      }
      bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
      if (is_float) packed_.add_whole(bits);
    }
    for (unsigned k = 0; k < 3; ++k) row.rgb[k] = (bits >> (16 - 8 * k)) & 0xff;
  }

  /// Whether a printed float is an integer to the last digit: "16711680", or "16711680.000000", which floats hold.
  static bool is_exact_integer(std::string_view token) {
    constexpr double kFirstInexact = 1 << 24;
    const std::size_t rest = token.find_first_not_of("0123456789");
    if (rest == std::string_view::npos) return true;
    double value = 0.0;
    return token[rest] == '.' && token.find_first_not_of('0', rest + 1) == std::string_view::npos &&
           parse_number(token, value) && value < kFirstInexact;
  }

  const LineReader& lines_;
  std::span<const Field> fields_;
  std::vector<Target> targets_;
  PackedFloats packed_;
};

}  // namespace

RowStage::RowStage(CloudBuilder& builder, bool has_color) : builder_(builder) {
  rows_.reserve(kRows);
  // Rows hold separate channels, whatever the file does.
  columns_.color = has_color ? ColorStorage::kSeparate : ColorStorage::kNone;
  const auto* base = reinterpret_cast<const std::byte*>(rows_.data());
  for (std::size_t k = 0; k < 3; ++k) {
    columns_.position[k] = {base + offsetof(Row, xyz) + k * sizeof(double), sizeof(Row), ScalarType::kFloat64};
    columns_.rgb[k] = {base + offsetof(Row, rgb) + k * sizeof(double), sizeof(Row), ScalarType::kFloat64};
  }
}

void RowStage::flush() {
  builder_.append(columns_, rows_.size());
  rows_.clear();
}

void require_ascii_rows(const ByteSource& source, std::uint64_t n, std::span<const Field> fields) {
  // A digit and a separator for each value at least; the last line may lack its end.
  std::uint64_t values = 0;
  for (const Field& field : fields) values += field.count;
  if (n > (source.remaining() + 1) / (2 * values)) {
    source.fail("truncated: {} points of {} values cannot lie in the {} bytes after byte {}", n, values,
                source.remaining(), source.position());
  }
}

void note_lines_left_over(LineReader& lines, FileInfo& info) {
  std::uint64_t n = 0;
  for (std::string_view line; lines.next(line);) n += next_token(line).empty() ? 0 : 1;
  if (n > 0) info.notes.push_back(fmt::format("{} more lines follow the last row that the header counts; not read", n));
}

void read_ascii_rows(LineReader& lines, std::uint64_t n, std::span<const Field> fields, const PointSchema& schema,
                     CloudBuilder& builder) {
  RowParser parser(lines, fields, schema);
  RowStage stage(builder, schema.layout.color.storage != ColorStorage::kNone);
  std::string_view line;
  for (std::uint64_t i = 0; i < n;) {
    if (!lines.next(line)) lines.fail("truncated: the file ends after {} of {} points", i, n);
    std::string_view rest = line;
    if (next_token(rest).empty()) continue;
    stage.add(parser.parse(line));
    ++i;
  }
  stage.flush();
  builder.add_packed(parser.packed());
}

}  // namespace cmap
