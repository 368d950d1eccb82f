#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace cmap {

/// Adds what is known of a metric to `metrics` by its id, as records do: as it is, or in `per_threshold`.
inline void add_entry(nlohmann::ordered_json& metrics, std::string_view id, std::optional<double> threshold_m,
                      nlohmann::ordered_json fields) {
  nlohmann::ordered_json& metric = metrics[std::string(id)];
  if (!threshold_m) {
    metric = std::move(fields);
    return;
  }
  nlohmann::ordered_json entry{{"threshold_m", *threshold_m}};
  entry.update(fields);
  metric["per_threshold"].push_back(std::move(entry));
}

}  // namespace cmap
