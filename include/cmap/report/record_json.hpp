#pragma once

#include <nlohmann/json.hpp>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// A number, or null where it is missing: NaN and infinity are no values in JSON.
nlohmann::ordered_json json_number(double v);

/// The record's tree: {threshold_m, value, numbers, parameters, parts, rows}, each by its name.
nlohmann::ordered_json record_json(const Record& record);

/// The report's `intervals`, `unobserved` and `sensitivity`.
nlohmann::ordered_json intervals_json(const Intervals& intervals);
nlohmann::ordered_json observed_json(const ObservedPart& observed, const EvaluationOptions& options);
nlohmann::ordered_json sensitivity_json(const Sensitivity& sensitivity);

/// The sums over blocks as reports keep them: {block_m, keys, sums: {column: [per block]}}. Throws UsageError on
/// anything else.
nlohmann::ordered_json block_sums_json(const BlockSums& blocks);
BlockSums block_sums_from(const nlohmann::ordered_json& json);

}  // namespace cmap
