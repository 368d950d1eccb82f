#include "containers/npy_array.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace cmap {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in the file");

bool is_fortran(const NpyHeader& header) { return header.fortran_order && header.shape.size() > 1; }

/// Where the items of an array in Fortran's order lie, in the order in which the last index is fastest.
class FortranWalk {
 public:
  explicit FortranWalk(const std::vector<std::uint64_t>& shape) : shape_(shape), index_(shape.size(), 0) {
    std::uint64_t step = 1;
    for (const std::uint64_t length : shape) {
      steps_.push_back(step);
      step *= length;
    }
  }
  std::uint64_t place() const { return place_; }
  void next() {
    for (std::size_t axis = shape_.size(); axis-- > 0;) {
      place_ += steps_[axis];
      if (++index_[axis] < shape_[axis]) return;
      place_ -= shape_[axis] * steps_[axis];
      index_[axis] = 0;
    }
  }

 private:
  const std::vector<std::uint64_t>& shape_;
  std::vector<std::uint64_t> index_, steps_;
  std::uint64_t place_ = 0;
};

/// The same fields in little endian, half floats as float32.
std::vector<NpyField> plain_fields(std::vector<NpyField> fields) {
  std::size_t offset = 0;
  for (NpyField& field : fields) {
    field.big_endian = false;
    if (field.kind == NpyKind::kHalf) {
      field.kind = NpyKind::kNumber;
      field.value_bytes = sizeof(float);
    }
    field.offset = offset;
    offset += field.bytes();
  }
  return fields;
}

void copy_field(const NpyField& field, const std::byte* from, std::byte* to) {
  const bool half = field.kind == NpyKind::kHalf;
  if (!half && (!field.big_endian || field.kind == NpyKind::kOther)) {
    std::memcpy(to, from, field.bytes());
    return;
  }
  for (std::size_t i = 0; i < field.count; ++i, from += field.value_bytes) {
    std::array<std::byte, 8> value;
    std::copy_n(from, field.value_bytes, value.begin());
    if (field.big_endian) std::reverse(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(field.value_bytes));
    if (half) {
      const auto bits = std::bit_cast<std::uint16_t>(std::array{value[0], value[1]});
      const float number = Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(bits));
      std::memcpy(to + i * sizeof(float), &number, sizeof(float));
    } else {
      std::memcpy(to + i * field.value_bytes, value.data(), field.value_bytes);
    }
  }
}

/// Brings an array as it lies in a file into the form that NpyArray promises; nearly every file has it already.
void make_plain(NpyArray& array) {
  NpyHeader& header = array.header;
  const bool fortran = is_fortran(header);
  header.fortran_order = false;
  const auto is_plain = [](const NpyField& f) { return !f.big_endian && f.kind != NpyKind::kHalf; };
  if (!fortran && std::all_of(header.fields.begin(), header.fields.end(), is_plain)) return;
  const std::vector<NpyField> stored = header.fields;
  const std::size_t stored_bytes = header.item_bytes;
  header.fields = plain_fields(stored);
  header.item_bytes = header.fields.back().offset + header.fields.back().bytes();
  Array<std::byte> bytes(header.items * header.item_bytes);
  FortranWalk walk(header.shape);
  for (std::uint64_t i = 0; i < header.items; ++i) {
    const std::byte* from = array.bytes.data() + (fortran ? walk.place() : i) * stored_bytes;
    for (std::size_t f = 0; f < stored.size(); ++f) {
      copy_field(stored[f], from + stored[f].offset, bytes.data() + i * header.item_bytes + header.fields[f].offset);
    }
    if (fortran) walk.next();
  }
  array.bytes = std::move(bytes);
}

template <class Out>
Array<Out> converted(const NpyArray& array) {
  const NpyField& field = array.header.fields[0];
  if (array.header.is_record() || field.kind == NpyKind::kOther) {
    array.fail("holds {}; plain numbers expected", array.header.type_text());
  }
  Array<Out> values(array.size());
  visit_scalar(field.scalar, [&]<class Stored>(Stored) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      Stored stored;
      std::memcpy(&stored, array.bytes.data() + i * sizeof(Stored), sizeof(Stored));
      values[i] = static_cast<Out>(stored);
    }
  });
  return values;
}

}  // namespace

Array<float> NpyArray::to_floats() const { return converted<float>(*this); }
Array<double> NpyArray::to_doubles() const { return converted<double>(*this); }

Array<std::uint8_t> NpyArray::to_bytes() const {
  const NpyField& field = header.fields[0];
  if (header.is_record() || field.scalar != ScalarType::kUint8 || field.kind == NpyKind::kOther) {
    fail("values of type {}; |u1 or |b1 expected", header.type_text());
  }
  return converted<std::uint8_t>(*this);
}

NpyArray read_npy(ByteSource& source) {
  NpyArray array{source.name(), {}, read_npy_header(source), {}};
  const std::uint64_t bytes = array.header.items * array.header.item_bytes;
  source.require(bytes, fmt::format("an array of shape {}", shape_text(array.shape())));
  if (source.remaining() > bytes) {
    source.fail("{} bytes follow the array of shape {}", source.remaining() - bytes, shape_text(array.shape()));
  }
  array.bytes.resize(bytes);
  source.read(array.bytes, "the array");
  make_plain(array);
  return array;
}

void write_npy(OutputFile& file, ScalarType type, const std::vector<std::uint64_t>& shape, const void* data) {
  constexpr std::size_t kAlignment = 64, kStart = 10;  // magic, version, length
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", npy_type_name(type), shape_text(shape));
  text.append(kAlignment - (kStart + text.size() + 1) % kAlignment, ' ');
  text += '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  file.write(std::string_view("\x93NUMPY\x01\x00", 8));
  file.write(&length, sizeof(length));
  file.write(text);
  std::size_t bytes = scalar_bytes(type);
  for (const std::uint64_t n : shape) bytes *= n;
  file.write(data, bytes);
}

}  // namespace cmap
