#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cmap {

/// A name for every value of an enumeration, or of another type with few values.
template <class Value>
using EnumNames = std::vector<std::pair<Value, std::string_view>>;

/// Empty for a value that has none.
template <class Value>
std::string_view name_of(const Value& value, const EnumNames<Value>& names) {
  for (const auto& [known, name] : names) {
    if (known == value) return name;
  }
  return {};
}

template <class Value>
std::vector<std::string> words_of(const EnumNames<Value>& names) {
  std::vector<std::string> words;
  for (const auto& [value, name] : names) words.emplace_back(name);
  return words;
}

}  // namespace cmap
