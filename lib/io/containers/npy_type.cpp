#include "containers/npy_type.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace cmap {
namespace {

constexpr std::string_view kReadableTypes = "f2, f4, f8, i1 to i8, u1 to u8 and b1";

/// The number of bytes, which the unit of a date may follow; 0 where the text gives none or an absurd one.
std::size_t length_of(std::string_view digits) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), length);
  const bool ends = end == digits.data() + digits.size() || *end == '[';
  return error == std::errc() && ends && length <= ByteSource::kMaxRecordBytes ? length : 0;
}

std::optional<ScalarType> number_type(char kind, std::size_t bytes) {
  const char pcd_kind = kind == 'i' ? 'I' : kind == 'u' ? 'U' : 'F';
  return scalar_from_pcd(pcd_kind, bytes);
}

/// Long doubles, complex numbers, text, raw bytes, dates.
bool is_other(char kind, std::size_t bytes) {
  if (kind == 'f') return bytes == 12 || bytes == 16;
  if (kind == 'c') return bytes == 8 || bytes == 16 || bytes == 24 || bytes == 32;
  return bytes > 0 && std::string_view("SaUVMm").find(kind) != std::string_view::npos;
}

/// A type such as "<f4", "|S10" or "<M8[ns]".
NpyField parse_type(const NpyHeaderText& text, std::string_view name) {
  if (name.find('O') != std::string_view::npos) {
    text.refuse("holds pickled Python objects ('{}'), which nothing but Python reads; save plain arrays",
                name.substr(0, 40));
  }
  NpyField field;
  field.type = name;
  field.big_endian = name.starts_with('>');
  if (name.find_first_of("<>|=") == 0) name.remove_prefix(1);
  const char kind = name.empty() ? ' ' : name[0];
  field.value_bytes = length_of(name.substr(name.empty() ? 0 : 1)) * (kind == 'U' ? 4 : 1);
  const std::size_t bytes = field.value_bytes;
  if (kind == 'b' && bytes == 1) {
    field.kind = NpyKind::kBool;
    field.scalar = ScalarType::kUint8;
  } else if (kind == 'f' && bytes == 2) {
    field.kind = NpyKind::kHalf;
  } else if (const auto type = number_type(kind, bytes); type && (kind == 'f' || kind == 'i' || kind == 'u')) {
    field.scalar = *type;
  } else if (is_other(kind, bytes)) {
    field.kind = NpyKind::kOther;
  } else {
    text.refuse("values of type '{}'; {} can be read", field.type.substr(0, 40), kReadableTypes);
  }
  return field;
}

void set_shape(const NpyHeaderText& text, NpyField& field, std::vector<std::uint64_t> shape) {
  field.shape = std::move(shape);
  for (const std::uint64_t length : field.shape) {
    if (length == 0 || length > ByteSource::kMaxRecordBytes / field.bytes()) {
      text.refuse("the member '{}' has an absurd shape", field.name);
    }
    field.count *= length;
  }
}

/// The name of a member: 'name' or ('title', 'name').
std::string take_name(NpyHeaderText& text) {
  if (!text.take('(')) return std::string(text.take_string());
  text.take_string();
  text.expect(',');
  std::string name(text.take_string());
  text.expect(')');
  return name;
}

std::size_t bytes_of(const std::vector<NpyField>& fields) {
  return fields.empty() ? 0 : fields.back().offset + fields.back().bytes();
}

void add(const NpyHeaderText& text, NpyField field, std::vector<NpyField>& fields) {
  field.offset = bytes_of(fields);
  fields.push_back(std::move(field));
  if (bytes_of(fields) > ByteSource::kMaxRecordBytes) {
    text.refuse("a record takes more than the accepted {} bytes", ByteSource::kMaxRecordBytes);
  }
}

std::vector<NpyField> take_members(NpyHeaderText& text, int depth);

/// A member that is a record itself: its own members, or bytes to step over where there are several such records.
void add_record(NpyHeaderText& text, const std::string& name, int depth, std::vector<NpyField>& fields) {
  std::vector<NpyField> inner = take_members(text, depth + 1);
  std::vector<std::uint64_t> shape;
  if (text.take(',') && !text.next_is(')')) shape = text.take_shape();
  if (shape.empty()) {
    for (NpyField& field : inner) {
      if (field.parent.empty()) field.parent = name;
      add(text, std::move(field), fields);
    }
    return;
  }
  NpyField several;
  several.name = name;
  several.type = "records";
  several.kind = NpyKind::kOther;
  several.value_bytes = bytes_of(inner);
  set_shape(text, several, std::move(shape));
  add(text, std::move(several), fields);
}

/// "[('x', '<f4'), ('rgb', '|u1', (3,)), ('', '|V1')]"
std::vector<NpyField> take_members(NpyHeaderText& text, int depth) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest) text.refuse("records within records, more than {} deep", kDeepest);
  std::vector<NpyField> fields;
  text.expect('[');
  while (!text.take(']')) {
    text.expect('(');
    const std::string name = take_name(text);
    text.expect(',');
    if (text.next_is('[')) {
      add_record(text, name, depth, fields);
    } else {
      NpyField field = parse_type(text, text.take_string());
      field.name = name;
      if (text.take(',') && !text.next_is(')')) set_shape(text, field, text.take_shape());
      add(text, std::move(field), fields);
    }
    text.take(',');
    text.expect(')');
    if (!text.take(',') && !text.next_is(']')) text.fail();
  }
  if (fields.empty()) text.refuse("records without members");
  return fields;
}

/// Members of two inner records may have the same name; that of the position keeps it.
void qualify_equal_names(std::vector<NpyField>& fields) {
  std::vector<std::string> names;
  for (const NpyField& field : fields) names.push_back(field.name);
  for (NpyField& field : fields) {
    if (field.parent.empty() || std::count(names.begin(), names.end(), field.name) < 2) continue;
    if (is_position_name(field.parent)) continue;
    field.name = field.parent + "." + field.name;
  }
}

}  // namespace

std::vector<NpyField> take_npy_fields(NpyHeaderText& text) {
  if (!text.next_is('[')) return {parse_type(text, text.take_string())};
  std::vector<NpyField> fields = take_members(text, 0);
  qualify_equal_names(fields);
  return fields;
}

bool is_position_name(std::string_view name) {
  constexpr std::string_view kNames[] = {"xyz",   "position", "positions",   "pos",      "point",    "points",
                                         "coord", "coords",   "coordinates", "location", "locations"};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(std::begin(kNames), std::end(kNames), lower) != std::end(kNames);
}

std::string npy_type_name(ScalarType type) {
  const char kind = is_floating(type) ? 'f' : scalar_min(type) < 0.0 ? 'i' : 'u';
  const std::size_t bytes = scalar_bytes(type);
  return fmt::format("{}{}{}", bytes == 1 ? '|' : '<', kind, bytes);
}

}  // namespace cmap
