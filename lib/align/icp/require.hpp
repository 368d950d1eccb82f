#pragma once

#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {

/// Throws the UsageError of an option that is out of its range.
inline void require(bool holds, const char* field, double value, const char* rule) {
  if (!holds) throw UsageError(fmt::format("{} is {:g}: {}", field, value, rule));
}

}  // namespace cmap
