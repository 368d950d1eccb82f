#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace cmap {

/// The sums at one place of a cell.
template <class Sums>
struct PlacedSums {
  std::int32_t place;
  Sums sums;
};

/// Sums windows of kParts parts in a row, whose places are `stride` apart: the window at w is of those at w, w +
/// stride, w + 2 stride. Calls merge(sums, part, w) for each of its parts and then emit(w, sums). The parts are ordered
/// by place, and so are the windows.
template <int kParts, class Sums, class Merge, class Emit>
void sum_windows(std::span<const PlacedSums<Sums>> parts, std::int32_t stride, Merge merge, Emit emit) {
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  std::array<std::size_t, kParts> next{};      // the first part that was not yet some window's first, second, third
  std::array<std::int32_t, kParts> window_of;  // that would have it there
  const auto find_window = [&](std::size_t k) {
    const bool is_end = next[k] == parts.size();
    window_of[k] = is_end ? kNone : parts[next[k]].place - static_cast<std::int32_t>(k) * stride;
  };
  for (std::size_t k = 0; k < kParts; ++k) find_window(k);
  for (std::int32_t window; (window = std::ranges::min(window_of)) != kNone;) {
    Sums sums{};
    for (std::size_t k = 0; k < kParts; ++k) {
      if (window_of[k] != window) continue;
      merge(sums, parts[next[k]++], window);
      find_window(k);
    }
    emit(window, sums);
  }
}

}  // namespace cmap
