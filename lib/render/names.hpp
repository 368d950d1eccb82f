#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"

namespace cmap {

/// The value of a name in a table. Throws UsageError that says what the names are.
template <class Value, std::size_t n>
Value value_of_name(std::string_view kind, std::string_view name,
                    const std::pair<std::string_view, Value> (&table)[n]) {
  std::vector<std::string> known;
  for (const auto& [known_name, value] : table) {
    if (name == known_name) return value;
    known.emplace_back(known_name);
  }
  throw UsageError(fmt::format("{} \"{}\" {}", kind, name, is_none_of(name, known)));
}

}  // namespace cmap
