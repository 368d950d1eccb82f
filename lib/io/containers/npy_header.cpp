#include <array>
#include <optional>

#include "containers/npy_array.hpp"

namespace cmap {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "\x93NUMPY"sv;

/// Sizes of an array of this shape; throws where they overflow.
void count_items(const NpyHeaderText& text, NpyHeader& header) {
  header.item_bytes = header.fields.back().offset + header.fields.back().bytes();
  std::uint64_t bytes = header.item_bytes;
  header.items = 1;
  for (const std::uint64_t length : header.shape) {
    if (__builtin_mul_overflow(bytes, length, &bytes)) text.refuse("the shape is absurd");
    header.items *= length;
  }
}

/// A Python dictionary of a type, a truth value and a tuple of whole numbers.
NpyHeader parse_header(NpyHeaderText text) {
  NpyHeader header;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::uint64_t>> shape;
  text.expect('{');
  while (!text.take('}')) {
    const std::string_view key = text.take_string();
    text.expect(':');
    if (key == "descr") {
      header.fields = take_npy_fields(text);
    } else if (key == "fortran_order") {
      fortran_order = text.take_truth();
    } else if (key == "shape") {
      shape = text.take_shape();
    } else {
      text.refuse("unknown key '{}'", key.substr(0, 40));
    }
    if (!text.take(',') && !text.next_is('}')) text.fail();
  }
  if (!text.at_end()) text.fail();
  if (header.fields.empty() || !fortran_order || !shape) text.refuse("descr, fortran_order and shape expected");
  header.fortran_order = *fortran_order;
  header.shape = std::move(*shape);
  count_items(text, header);
  return header;
}

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

std::string NpyHeader::type_text() const {
  if (!is_record()) return fields[0].type;
  std::vector<std::string_view> names;
  for (const NpyField& field : fields) {
    if (!field.name.empty()) names.push_back(field.name);
  }
  return fmt::format("records of {}", fmt::join(names, ", "));
}

NpyHeader read_npy_header(ByteSource& source) {
  const std::uint32_t length = read_header_length(source);
  source.require(length, "the NPY header");
  std::string text(length, '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the NPY header");
  return parse_header({source, text});
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
