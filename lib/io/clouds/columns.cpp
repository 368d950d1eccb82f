#include "clouds/columns.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace cmap {
namespace {

template <class T, bool swap>
T load(const std::byte* place) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), place, sizeof(T));
  if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// One column into every third value of `out`. `map` turns a stored value into the wanted one.
template <class In, bool swap, class Out, class Map>
void decode_loop(const std::byte* data, std::size_t stride, std::size_t n, Out* out, Map map) {
  for (std::size_t i = 0; i < n; ++i) out[3 * i] = map(load<In, swap>(data + i * stride));
}

template <class Out, class Map>
void decode_column(const Column& column, bool swap, std::size_t first, std::size_t n, Out* out, Map map) {
  const std::byte* data = column.data + first * column.stride;
  visit_scalar(column.type, [&](auto value) {
    using In = decltype(value);
    if (swap) {
      decode_loop<In, true>(data, column.stride, n, out, map);
    } else {
      decode_loop<In, false>(data, column.stride, n, out, map);
    }
  });
}

/// Whether the three columns are neighbors of one type, as in a record "x y z".
bool adjacent(const std::array<Column, 3>& columns, ScalarType type) {
  const std::size_t bytes = scalar_bytes(type);
  for (std::size_t k = 0; k < 3; ++k) {
    if (columns[k].type != type || columns[k].stride != columns[0].stride) return false;
    if (columns[k].data != columns[0].data + k * bytes) return false;
  }
  return true;
}

/// The layout that nearly every file has: whole triples copied out of the records.
template <std::size_t bytes>
void copy_triples(const Column& column, std::size_t first, std::size_t n, void* out) {
  const std::byte* from = column.data + first * column.stride;
  auto* to = static_cast<std::byte*>(out);
  for (std::size_t i = 0; i < n; ++i) std::memcpy(to + i * bytes, from + i * column.stride, bytes);
}

}  // namespace

template <class Real>
void decode_positions(const PointColumns& columns, std::size_t first, std::size_t n, Real* xyz) {
  constexpr ScalarType kSame = std::is_same_v<Real, float> ? ScalarType::kFloat32 : ScalarType::kFloat64;
  if (!columns.swap_bytes && !columns.scaled && adjacent(columns.position, kSame)) {
    return copy_triples<3 * sizeof(Real)>(columns.position[0], first, n, xyz);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Column& column = columns.position[axis];
    if (columns.scaled) {
      const double scale = columns.scale[axis];
      const double offset = columns.offset[axis];
      decode_column(column, columns.swap_bytes, first, n, xyz + axis,
                    [=](auto value) { return static_cast<Real>(static_cast<double>(value) * scale + offset); });
    } else {
      decode_column(column, columns.swap_bytes, first, n, xyz + axis,
                    [](auto value) { return static_cast<Real>(value); });
    }
  }
}

template <class Channel>
void decode_colors(const PointColumns& columns, std::size_t first, std::size_t n, Channel* rgb) {
  if constexpr (std::is_same_v<Channel, std::uint8_t>) {
    if (columns.color == ColorStorage::kPacked) {
      const Column packed{columns.rgb[0].data, columns.rgb[0].stride, ScalarType::kUint32};
      for (unsigned k = 0; k < 3; ++k) {
        decode_column(packed, columns.swap_bytes, first, n, rgb + k, [shift = 16 - 8 * k](auto value) {
          return static_cast<Channel>((static_cast<std::uint32_t>(value) >> shift) & 0xff);
        });
      }
      return;
    }
  }
  constexpr ScalarType kSame = std::is_same_v<Channel, std::uint8_t>    ? ScalarType::kUint8
                               : std::is_same_v<Channel, std::uint16_t> ? ScalarType::kUint16
                                                                        : ScalarType::kFloat32;
  const bool in_order = sizeof(Channel) == 1 || !columns.swap_bytes;
  if (in_order && adjacent(columns.rgb, kSame)) return copy_triples<3 * sizeof(Channel)>(columns.rgb[0], first, n, rgb);
  for (std::size_t k = 0; k < 3; ++k) {
    decode_column(columns.rgb[k], columns.swap_bytes, first, n, rgb + k,
                  [](auto value) { return static_cast<Channel>(value); });
  }
}

void decode_packed(const PointColumns& columns, std::size_t first, std::size_t n, float* values) {
  const std::byte* data = columns.rgb[0].data + first * columns.rgb[0].stride;
  for (std::size_t i = 0; i < n; ++i) {
    const std::byte* place = data + i * columns.rgb[0].stride;
    values[i] = columns.swap_bytes ? load<float, true>(place) : load<float, false>(place);
  }
}

template void decode_positions(const PointColumns&, std::size_t, std::size_t, float*);
template void decode_positions(const PointColumns&, std::size_t, std::size_t, double*);
template void decode_colors(const PointColumns&, std::size_t, std::size_t, std::uint8_t*);
template void decode_colors(const PointColumns&, std::size_t, std::size_t, std::uint16_t*);
template void decode_colors(const PointColumns&, std::size_t, std::size_t, float*);

}  // namespace cmap
