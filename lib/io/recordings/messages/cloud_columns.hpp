#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "recordings/messages/point_cloud2.hpp"

namespace cmap {

/// Calls run(first, n, begin) for runs of points that lie point_step apart: n of them from byte `first` on, the first
/// of which is point `begin`.
template <class Run>
void for_each_run(const PointCloud2& cloud, Run&& run) {
  const std::size_t row_bytes = std::size_t{cloud.width} * cloud.point_step;
  if (cloud.row_step == row_bytes) {
    run(cloud.data.data(), cloud.n_points(), std::size_t{0});
    return;
  }
  for (std::size_t row = 0; row < cloud.height; ++row) {
    run(cloud.data.data() + row * cloud.row_step, std::size_t{cloud.width}, row * cloud.width);
  }
}

template <class T, bool kSwapped>
T load_number(const std::byte* place) {
  std::array<std::byte, sizeof(T)> raw;
  std::memcpy(raw.data(), place, sizeof(T));
  if constexpr (kSwapped) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Calls put(i, value) with the field's number of every point.
template <class Put>
void for_each_number(const PointCloud2& cloud, const CloudField& field, Put&& put) {
  const auto walk = [&]<class T, bool kSwapped>(T, std::bool_constant<kSwapped>) {
    for_each_run(cloud, [&](const std::byte* first, std::size_t n, std::size_t begin) {
      const std::byte* place = first + field.offset;
      for (std::size_t i = 0; i < n; ++i, place += cloud.point_step) put(begin + i, load_number<T, kSwapped>(place));
    });
  };
  visit_scalar(field.type, [&]<class T>(T value) {
    if (cloud.is_big_endian == (std::endian::native == std::endian::big)) {
      walk(value, std::false_type());
    } else {
      walk(value, std::true_type());
    }
  });
}

}  // namespace cmap
