#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "cmap/core/error.hpp"

namespace cmap {

/// The value of a name in a table. Throws UsageError that says what the names are.
template <class Value, std::size_t n>
Value value_of_name(std::string_view kind, std::string_view name,
                    const std::pair<std::string_view, Value> (&table)[n]) {
  std::string known;
  for (const auto& [known_name, value] : table) {
    if (name == known_name) return value;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", known_name);
  }
  throw UsageError(fmt::format("{} \"{}\" is none of {}", kind, name, known));
}

}  // namespace cmap
