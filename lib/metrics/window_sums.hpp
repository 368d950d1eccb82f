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
/// stride, w + 2 stride. Calls emit(w, sums). The parts are ordered by place, and so are the windows.
template <int kParts, class Sums, class Emit>
void sum_windows(std::span<const PlacedSums<Sums>> parts, std::int32_t stride, Emit emit) {
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  std::array<std::size_t, kParts> next{};      // the first part that was not yet some window's first, second, third
  std::array<std::int32_t, kParts> window_of;  // that would have it there
  const auto find_window = [&](std::size_t k) {
    const bool is_end = next[k] == parts.size();
    window_of[k] = is_end ? kNone : parts[next[k]].place - static_cast<std::int32_t>(k) * stride;
  };
  for (std::size_t k = 0; k < kParts; ++k) find_window(k);
  for (std::int32_t window; (window = std::ranges::min(window_of)) != kNone;) {
    std::size_t k = 0;
    const auto next_part = [&]() -> const Sums& {
      while (window_of[k] != window) ++k;
      const Sums& part = parts[next[k]++].sums;
      find_window(k++);
      return part;
    };
    const auto n_parts = std::ranges::count(window_of, window);
    Sums sums = next_part();
    for (std::ptrdiff_t i = 1; i < n_parts; ++i) sums += next_part();
    emit(window, sums);
  }
}

/// The same with a stride of 1, of parts that are given one by one.
template <int kParts, class Sums>
class RowWindows {
 public:
  template <class Emit>
  void add(std::int32_t place, const Sums& part, Emit emit) {
    const std::int32_t n_done = std::min(place - last_, kParts);
    for (std::int32_t i = 0; i < n_done; ++i) {
      if (is_open_) emit(last_ + 1 - kParts + i, oldest());
      oldest() = part;
      turn();
    }
    is_open_ = true;
    last_ = place;
    for (std::size_t i = 0; i < static_cast<std::size_t>(kParts - n_done); ++i) open_[(oldest_ + i) % kParts] += part;
  }
  /// After the last part.
  template <class Emit>
  void finish(Emit emit) {
    for (std::int32_t i = 0; i < kParts && is_open_; ++i, turn()) emit(last_ + 1 - kParts + i, oldest());
    is_open_ = false;
  }

 private:
  Sums& oldest() { return open_[oldest_]; }
  void turn() { oldest_ = (oldest_ + 1) % kParts; }

  std::array<Sums, kParts> open_{};  ///< the windows that have the last part, in turn
  std::size_t oldest_ = 0;
  bool is_open_ = false;
  std::int32_t last_ = -kParts;
};

}  // namespace cmap
