#include "clouds/largest_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace cmap {

std::size_t largest_part(std::span<const std::size_t> sizes, const char* parts, FileInfo& info) {
  const auto largest = std::ranges::max_element(sizes);
  const std::size_t n_others = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}) - *largest;
  if (n_others > 0) {
    info.warnings.push_back({"parts_unused", fmt::format("the largest of {} {} is used; the others' {} points are not",
                                                         sizes.size(), parts, n_others)});
  }
  return static_cast<std::size_t>(largest - sizes.begin());
}

}  // namespace cmap
