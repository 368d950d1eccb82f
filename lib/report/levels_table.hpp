#pragma once

// What of a table says what a number is worth (METRICS "Levels").

#include <nlohmann/json.hpp>
#include <string>

#include "cmap/eval/metric_catalog.hpp"

namespace cmap {

/// Whether this record has a floor, a chance or a skill, its own or at thresholds; reports of before have none.
bool has_levels(const nlohmann::ordered_json& metric);

/// The names of the columns, as level_columns has them.
std::string level_heading();

/// Floor, chance and skill of a record, as columns; a dash where one has no value, blank where there is none.
std::string level_columns(const MetricInfo& info, const nlohmann::ordered_json& metric);

/// "0.298 ± 0.097 over 8 grids": mean and deviation over where the voxels' grid begins; empty of a record without.
std::string phases_text(const nlohmann::ordered_json& metric);

/// Why levels have no value, a line for each reason, under a heading; empty where all have one.
std::string missing_level_lines(const nlohmann::ordered_json& report);

}  // namespace cmap
