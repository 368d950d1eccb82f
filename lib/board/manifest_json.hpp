#pragma once

// Members of a manifest, with errors that say where and what.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cmap/core/error.hpp"

namespace cmap {

using ManifestJson = nlohmann::ordered_json;

/// Throws UsageError for anything but an object with these keys alone.
inline void require_keys(const ManifestJson& object, const std::string& place,
                         std::initializer_list<std::string_view> known) {
  if (!object.is_object()) throw UsageError(fmt::format("{}: expected an object", place));
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::count(known, key) == 0) {
      throw UsageError(fmt::format("{}: unknown key \"{}\"; keys are {}", place, key, fmt::join(known, ", ")));
    }
  }
}

inline const ManifestJson& required(const ManifestJson& object, const std::string& place, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw UsageError(fmt::format("{}: has no \"{}\"", place, key));
  return *found;
}

inline std::string text_in(const ManifestJson& value, const std::string& place) {
  if (!value.is_string()) throw UsageError(fmt::format("{}: {} is no text", place, value.dump()));
  return value.get<std::string>();
}

inline const ManifestJson& list_in(const ManifestJson& value, const std::string& place) {
  if (!value.is_array()) throw UsageError(fmt::format("{}: expected a list", place));
  return value;
}

inline const ManifestJson& object_in(const ManifestJson& value, const std::string& place) {
  if (!value.is_object()) throw UsageError(fmt::format("{}: expected an object", place));
  return value;
}

}  // namespace cmap
