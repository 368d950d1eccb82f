#include <array>
#include <charconv>
#include <optional>

#include "io/npy_array.hpp"

namespace cmap {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "\x93NUMPY"sv;
constexpr std::array kNames{"<f2"sv, "<f4"sv, "<f8"sv, "|u1"sv, "|b1"sv, "<i4"sv, "<i8"sv};
constexpr std::string_view kReadable = "<f2 <f4 <f8 |u1 |b1 <i4 <i8";

/// The text of a header: a Python dictionary of a string, a truth value and a tuple of whole numbers.
class HeaderText {
 public:
  HeaderText(const ByteSource& source, std::string_view text) : source_(source), text_(text) {}

  NpyHeader parse() {
    expect('{');
    while (!take('}')) {
      parse_entry();
      if (!take(',') && !next_is('}')) fail();
    }
    skip_blanks();
    if (!text_.empty()) fail();
    if (!type_ || !fortran_order_ || !shape_) source_.fail("NPY header: descr, fortran_order and shape expected");
    if (*fortran_order_ && shape_->size() > 1) {
      source_.fail("NPY header: the array is in Fortran order; C order expected (numpy.ascontiguousarray)");
    }
    return {*type_, *shape_, product()};
  }

 private:
  void parse_entry() {
    const std::string_view key = take_string();
    expect(':');
    if (key == "descr") {
      type_ = parse_type();
    } else if (key == "fortran_order") {
      fortran_order_ = parse_truth();
    } else if (key == "shape") {
      shape_ = parse_shape();
    } else {
      source_.fail("NPY header: unknown key '{}'", key.substr(0, 40));
    }
  }

  NpyType parse_type() {
    if (next_is('[')) source_.fail("NPY header: an array of records; plain numbers ({}) expected", kReadable);
    const std::string_view name = take_string();
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (kNames[i] == name) return static_cast<NpyType>(i);
    }
    if (name.starts_with('>'))
      source_.fail("NPY header: the values are big-endian ('{}'); {} can be read", name, kReadable);
    if (name.ends_with('O'))
      source_.fail("NPY header: holds pickled Python objects ('{}'); {} can be read", name, kReadable);
    source_.fail("NPY header: values of type '{}'; {} can be read", name.substr(0, 40), kReadable);
  }

  bool parse_truth() {
    skip_blanks();
    for (const bool value : {false, true}) {
      const std::string_view word = value ? "True" : "False";
      if (!text_.starts_with(word)) continue;
      text_.remove_prefix(word.size());
      return value;
    }
    fail();
  }

  std::vector<std::uint64_t> parse_shape() {
    constexpr std::size_t kMostDimensions = 32;  // NumPy's own limit
    std::vector<std::uint64_t> shape;
    expect('(');
    while (!take(')')) {
      skip_blanks();
      std::uint64_t length = 0;
      const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), length);
      if (error != std::errc() || shape.size() == kMostDimensions) fail();
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      shape.push_back(length);
      take('L');  // Python 2's long numbers
      if (!take(',') && !next_is(')')) fail();
    }
    return shape;
  }

  std::uint64_t product() const {
    std::uint64_t bytes = npy_type_bytes(*type_), values = 1;
    for (const std::uint64_t length : *shape_) {
      if (__builtin_mul_overflow(bytes, length, &bytes)) source_.fail("NPY header: the shape is absurd");
      values *= length;
    }
    return values;
  }

  std::string_view take_string() {
    skip_blanks();
    if (text_.empty() || (text_[0] != '\'' && text_[0] != '"')) fail();
    const std::size_t end = text_.find(text_[0], 1);
    if (end == std::string_view::npos) fail();
    const std::string_view content = text_.substr(1, end - 1);
    text_.remove_prefix(end + 1);
    return content;
  }

  void skip_blanks() { text_.remove_prefix(std::min(text_.size(), text_.find_first_not_of(" \t\r\n"))); }
  bool next_is(char c) {
    skip_blanks();
    return text_.starts_with(c);
  }
  bool take(char c) {
    if (!next_is(c)) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail();
  }
  [[noreturn]] void fail() const { source_.fail("NPY header: malformed before '{}'", text_.substr(0, 20)); }

  const ByteSource& source_;
  std::string_view text_;
  std::optional<NpyType> type_;
  std::optional<bool> fortran_order_;
  std::optional<std::vector<std::uint64_t>> shape_;
};

/// The length of the header's text: 2 bytes in version 1, 4 later.
std::uint32_t read_header_length(ByteSource& source) {
  std::array<std::byte, 8> start;
  source.read(start, "the start of an NPY file");
  if (std::string_view(reinterpret_cast<const char*>(start.data()), kMagic.size()) != kMagic) {
    source.fail("is no NPY file: it does not start with \\x93NUMPY");
  }
  const auto major = std::to_integer<unsigned>(start[6]);
  if (major < 1 || major > 3)
    source.fail("NPY version {}.{}; 1.0 to 3.0 can be read", major, std::to_integer<unsigned>(start[7]));
  std::array<std::byte, 4> bytes{};
  source.read(std::span(bytes).first(major == 1 ? 2 : 4), "the length of the NPY header");
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  if (length > ByteSource::kMaxRecordBytes) {
    source.fail("NPY header: {} bytes; at most {} accepted", length, ByteSource::kMaxRecordBytes);
  }
  return length;
}

}  // namespace

std::size_t npy_type_bytes(NpyType type) {
  constexpr std::array<std::size_t, 7> kBytes{2, 4, 8, 1, 1, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::string_view npy_type_name(NpyType type) { return kNames[static_cast<std::size_t>(type)]; }

NpyHeader read_npy_header(ByteSource& source) {
  const std::uint32_t length = read_header_length(source);
  source.require(length, "the NPY header");
  std::string text(length, '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the NPY header");
  return HeaderText(source, text).parse();
}

bool holds_python_objects(std::string_view start_of_npy) {
  if (!start_of_npy.starts_with(kMagic)) return false;
  const std::string_view header = start_of_npy.substr(0, start_of_npy.find('}'));
  return header.find("'|O'") != std::string_view::npos;
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  return shape.size() == 1 ? fmt::format("({},)", shape[0]) : fmt::format("({})", fmt::join(shape, ", "));
}

}  // namespace cmap
