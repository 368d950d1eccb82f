#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/sim/predictions.hpp"

namespace cmap {

std::vector<SessionRange> cut_sessions(std::size_t frames, int length, int overlap) {
  if (overlap < 0 || length <= overlap) {
    throw UsageError(fmt::format("session_overlap {} must be at least 0 and below session_length {}", overlap, length));
  }
  const auto full = static_cast<std::size_t>(length), step = static_cast<std::size_t>(length - overlap);
  std::vector<SessionRange> sessions;
  for (std::size_t first = 0; first < frames; first += step) {
    sessions.push_back({first, std::min(full, frames - first)});
    if (first + full >= frames) break;
  }
  return sessions;
}

}  // namespace cmap
