#include "cmap/colorize/observations.hpp"

#include <algorithm>

namespace cmap {

void Observations::add(std::size_t point, const Observation& seen) {
  ++seen_[point];
  Observation* const first = kept_.data() + point * most_;
  if (counts_[point] < most_) {
    first[counts_[point]++] = seen;
    return;
  }
  Observation* const least = std::min_element(
      first, first + most_, [](const Observation& a, const Observation& b) { return a.weight < b.weight; });
  if (seen.weight > least->weight) *least = seen;
}

}  // namespace cmap
