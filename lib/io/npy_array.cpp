#include "io/npy_array.hpp"

#include <Eigen/Core>
#include <bit>
#include <cstring>

namespace cmap {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in the file");

/// Calls f with a value of the C++ type that `type` stands for.
template <class F>
void visit_npy_type(NpyType type, F&& f) {
  switch (type) {
    case NpyType::kFloat16:
      return f(Eigen::half{});
    case NpyType::kFloat32:
      return f(float{});
    case NpyType::kFloat64:
      return f(double{});
    case NpyType::kUint8:
    case NpyType::kBool:
      return f(std::uint8_t{});
    case NpyType::kInt32:
      return f(std::int32_t{});
    case NpyType::kInt64:
      return f(std::int64_t{});
  }
}

template <class Out>
Array<Out> converted(const NpyArray& array) {
  Array<Out> values(array.size());
  visit_npy_type(array.header.type, [&]<class Stored>(Stored) {
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
  if (header.type != NpyType::kUint8 && header.type != NpyType::kBool) {
    fail("values of type {}; |u1 or |b1 expected", npy_type_name(header.type));
  }
  return converted<std::uint8_t>(*this);
}

NpyArray read_npy(ByteSource& source) {
  NpyArray array{source.name(), read_npy_header(source), {}};
  const std::uint64_t bytes = array.header.values * npy_type_bytes(array.header.type);
  source.require(bytes, fmt::format("an array of shape {}", shape_text(array.shape())));
  if (source.remaining() > bytes) {
    source.fail("{} bytes follow the array of shape {}", source.remaining() - bytes, shape_text(array.shape()));
  }
  array.bytes.resize(bytes);
  source.read(array.bytes, "the array");
  return array;
}

void write_npy(OutputFile& file, NpyType type, const std::vector<std::uint64_t>& shape, const void* data) {
  constexpr std::size_t kAlignment = 64, kStart = 10;  // magic, version, length
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", npy_type_name(type), shape_text(shape));
  text.append(kAlignment - (kStart + text.size() + 1) % kAlignment, ' ');
  text += '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  file.write(std::string_view("\x93NUMPY\x01\x00", 8));
  file.write(&length, sizeof(length));
  file.write(text);
  std::size_t bytes = npy_type_bytes(type);
  for (const std::uint64_t n : shape) bytes *= n;
  file.write(data, bytes);
}

}  // namespace cmap
