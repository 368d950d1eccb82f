#pragma once

#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {

/// Throws UsageError naming the option, its value and the rule, also for NaN.
template <class Value>
void require_at_least(const char* option, Value value, Value least) {
  if (!(value >= least)) throw UsageError(fmt::format("{} is {}: it must be at least {}", option, value, least));
}
template <class Value>
void require_between(const char* option, Value value, Value least, Value most) {
  if (!(value >= least && value <= most)) {
    throw UsageError(fmt::format("{} is {}: it must lie between {} and {}", option, value, least, most));
  }
}

}  // namespace cmap
