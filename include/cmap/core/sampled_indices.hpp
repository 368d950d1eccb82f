#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cmap {

/// At most `n_wanted` of the indices below n, evenly spread: the same ones on every machine.
inline std::vector<std::size_t> sampled_indices(std::size_t n, std::size_t n_wanted) {
  std::vector<std::size_t> indices(std::min(n, n_wanted));
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i * n / indices.size();
  return indices;
}

}  // namespace cmap
