#pragma once

#include <cstddef>
#include <cstdint>

#include "cmap/core/array.hpp"

namespace cmap {

/// Sorts 64-bit values by their bits from `low_bit` on, stable, least significant digit first; `scratch` is resized to
/// the same length. Deterministic for any number of threads.
void radix_sort(Array<std::uint64_t>& values, Array<std::uint64_t>& scratch, int low_bit, int high_bit);

}  // namespace cmap
