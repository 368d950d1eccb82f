#include "clouds/numpy/npz_colors.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace cmap {
namespace {

using Shape = std::vector<std::uint64_t>;

std::uint64_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

/// Without the dimensions of 1 in front.
Shape stripped(Shape shape) {
  const auto first = std::find_if(shape.begin(), shape.end(), [](std::uint64_t length) { return length != 1; });
  shape.erase(shape.begin(), first);
  return shape;
}

bool same_points(const Shape& shape, const Shape& point_shape) {
  const Shape a = stripped(shape), b = stripped(point_shape);
  return a == b || (product(a) == product(b) && (a.size() < 2 || b.size() < 2));
}

}  // namespace

std::optional<PointMatch> match_points(const Shape& shape, std::size_t channels, const Shape& point_shape) {
  if (channels == 1 && same_points(shape, point_shape)) return PointMatch{};
  if (shape.empty()) return std::nullopt;
  Shape rest = shape;
  rest.pop_back();
  if (shape.back() == channels && same_points(rest, point_shape)) return PointMatch{channels, false, 1};
  if (shape.size() < 2 || channels == 1) return std::nullopt;
  const std::size_t axis = shape.size() < 3 ? 0 : shape.size() - 3;
  rest = shape;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(axis));
  if (shape[axis] != channels || !same_points(rest, point_shape)) return std::nullopt;
  return PointMatch{channels, true, product(Shape(shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(axis)))};
}

std::optional<PointMatch> match_colors(const Shape& shape, const Shape& point_shape) {
  const auto match = match_points(shape, 3, point_shape);
  return match ? match : match_points(shape, 4, point_shape);
}

void set_colors(NpyPoints& points, const NpyArray& colors, const PointMatch& match) {
  const ScalarType type = colors.header.fields[0].scalar;
  const std::size_t bytes = scalar_bytes(type);
  const std::uint64_t frame_points = points.n / match.frames;
  const std::size_t channel_bytes = match.planes ? frame_points * bytes : bytes;  // from one channel to the next
  std::array<Column, 3> rgb;
  for (std::size_t k = 0; k < 3; ++k) {
    rgb[k] = {colors.bytes.data() + k * channel_bytes, match.planes ? bytes : match.channels * bytes, type};
  }
  set_colors(points, rgb);
  if (!match.planes) return;
  points.frame_points = frame_points;
  points.frame_color_bytes = match.channels * frame_points * bytes;
}

void set_colors(NpyPoints& points, const std::vector<const NpyArray*>& channels) {
  std::array<Column, 3> rgb;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScalarType type = channels[k]->header.fields[0].scalar;
    rgb[k] = {channels[k]->bytes.data(), scalar_bytes(type), type};
  }
  set_colors(points, rgb);
}

void set_packed_colors(NpyPoints& points, const NpyArray& packed) {
  points.columns.rgb[0] = {packed.bytes.data(), sizeof(std::uint32_t), packed.header.fields[0].scalar};
  points.columns.color = points.layout.color.storage = ColorStorage::kPacked;
  points.layout.color.type = ScalarType::kUint8;
}

}  // namespace cmap
