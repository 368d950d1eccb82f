#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// Whether this version reads reports of that schema.
bool is_known_schema(const nlohmann::ordered_json& schema);

/// Gives a report of an earlier version the options that it did not know, at the values at which they change nothing,
/// and its color consistency the parameter that says what it was. Its schema stays: it tells its definitions.
void complete_earlier_report(nlohmann::ordered_json& report);

/// What a schema changed about a metric, for whoever compares reports from before and since.
struct DefinitionChange {
  std::string_view schema;  ///< since
  std::string_view metric;
  bool mixes = false;  ///< values from before and since may stand side by side; else they do not compare
  std::string_view what;
};
const std::vector<DefinitionChange>& definition_changes();

/// Whether the report is from before the change.
bool is_before(const nlohmann::ordered_json& report, const DefinitionChange& change);

}  // namespace cmap
