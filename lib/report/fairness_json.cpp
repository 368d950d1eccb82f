#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/report/record_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Adds what is known of a value to `metrics` by its metric, as records do: as it is, or in `per_threshold`.
void add_entry(Json& metrics, std::string_view id, std::optional<double> threshold_m, Json fields) {
  Json& metric = metrics[std::string(id)];
  if (!threshold_m) {
    metric = std::move(fields);
    return;
  }
  Json entry{{"threshold_m", *threshold_m}};
  entry.update(fields);
  metric["per_threshold"].push_back(std::move(entry));
}

Json left_out_json(const UnobservedPoints& points) {
  return {{"n_unobserved", points.n}, {"share_unobserved", points.share}};
}

}  // namespace

Json intervals_json(const Intervals& intervals) {
  Json metrics = Json::object();
  for (const Interval& v : intervals.metrics) {
    add_entry(metrics, v.id, v.threshold_m, {{"lower", json_number(v.lower)}, {"upper", json_number(v.upper)}});
  }
  return {{"method", "spatial block bootstrap, percentiles"}, {"level", intervals.options.level},
          {"replicates", intervals.options.n_replicates},     {"seed", intervals.options.seed},
          {"n_blocks", intervals.blocks.keys.size()},         {"metrics", metrics},
          {"blocks", block_sums_json(intervals.blocks)}};
}

Json observed_json(const ObservedPart& observed, const EvaluationOptions& options) {
  const bool by_sensor = observed.method == Observed::kSensor;
  Json json{{"method", by_sensor ? "sensor" : "auto"}, {"column_m", observed.column_m}};
  if (by_sensor) {
    json["voxel_m"] = options.visibility.voxel_m;
    json["range_m"] = options.visibility.range_m;
    json["n_positions"] = observed.n_positions;
  }
  json["estimate"] = left_out_json(observed.left_out.estimate);
  json["reference"] = left_out_json(observed.left_out.reference);
  json["metrics"] = Json::object();
  for (const SummedValue& v : observed.values) {
    add_entry(json["metrics"], v.id, v.threshold_m, {{"value", json_number(v.value)}});
  }
  return json;
}

Json sensitivity_json(const Sensitivity& sensitivity) {
  Json metrics = Json::object();
  for (const SensitivityRange& range : sensitivity.ranges) {
    add_entry(metrics, range.id, range.threshold_m,
              {{"lowest", json_number(range.lowest)}, {"highest", json_number(range.highest)}});
  }
  return {
      {"translation_m", sensitivity.translation_m}, {"rotation_deg", sensitivity.rotation_deg}, {"metrics", metrics}};
}

Json block_sums_json(const BlockSums& blocks) {
  return {{"block_m", blocks.block_m}, {"keys", blocks.keys}, {"sums", blocks.sums.columns}};
}

BlockSums block_sums_from(const Json& json) {
  BlockSums blocks;
  try {
    blocks.block_m = json.at("block_m").get<double>();
    blocks.keys = json.at("keys").get<std::vector<std::array<std::int64_t, 3>>>();
    blocks.sums = {blocks.keys.size(), json.at("sums").get<std::map<std::string, std::vector<double>>>()};
  } catch (const Json::exception&) {
    throw UsageError("the report's blocks are damaged");
  }
  const bool whole = std::ranges::all_of(
      blocks.sums.columns, [&](const auto& column) { return column.second.size() == blocks.keys.size(); });
  if (!whole || !std::ranges::is_sorted(blocks.keys)) throw UsageError("the report's blocks are damaged");
  return blocks;
}

}  // namespace cmap
