#include "cmap/spatial/radix_sort.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kPart = std::size_t{1} << 20;

using Histogram = std::array<std::uint32_t, kDigits>;

std::size_t digit(std::uint64_t value, int shift) { return (value >> shift) & (kDigits - 1); }

/// Turns the counts of every part into the places where its values of each digit begin.
/// Returns false if all values share one digit: nothing to move.
bool counts_to_places(std::vector<Histogram>& parts, std::size_t n) {
  std::uint32_t place = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    const std::uint32_t begin = place;
    for (Histogram& part : parts) {
      const std::uint32_t count = part[d];
      part[d] = place;
      place += count;
    }
    if (place - begin == n) return false;
  }
  return true;
}

}  // namespace

void radix_sort(Array<std::uint64_t>& values, Array<std::uint64_t>& scratch, int low_bit, int high_bit) {
  const std::size_t n = values.size();
  scratch.resize(n);
  std::vector<Histogram> parts((n + kPart - 1) / kPart);
  for (int shift = low_bit; shift < high_bit; shift += kDigitBits) {
    parallel_chunks(n, kPart, [&](std::size_t begin, std::size_t end) {
      Histogram& histogram = parts[begin / kPart];
      histogram.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++histogram[digit(values[i], shift)];
    });
    if (!counts_to_places(parts, n)) continue;
    parallel_chunks(n, kPart, [&](std::size_t begin, std::size_t end) {
      Histogram& place = parts[begin / kPart];
      for (std::size_t i = begin; i < end; ++i) scratch[place[digit(values[i], shift)]++] = values[i];
    });
    values.swap(scratch);
  }
}

}  // namespace cmap
