#include <cmath>

#include "cmap/board/leaderboard.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "manifest_json.hpp"

namespace cmap {
namespace {

using Json = ManifestJson;

std::optional<double> number_or_null(const Json& value, const std::string& place) {
  if (value.is_null()) return std::nullopt;
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw UsageError(fmt::format("{}: {} is neither a number nor null", place, value.dump()));
  }
  return value.get<double>();
}

const MetricInfo& metric_called(const std::string& id, const std::string& place) {
  const MetricInfo* info = find_metric(id);
  if (info == nullptr || info->id != id) throw UsageError(fmt::format("{}: \"{}\" is no metric's id", place, id));
  return *info;
}

PublishedScores::Metric metric_in(const std::string& id, const Json& sequences) {
  const std::string place = "published.metrics." + id;
  PublishedScores::Metric metric{std::string(metric_called(id, "published.metrics").id), {}};
  for (const auto& [sequence, methods] : object_in(sequences, place).items()) {
    const std::string below = place + "." + sequence;
    for (const auto& [method, value] : object_in(methods, below).items()) {
      metric.entries.push_back({sequence, method, number_or_null(value, below + "." + method)});
    }
  }
  return metric;
}

std::vector<PublishedScores::Registration> registration_in(const Json& json) {
  const std::string place = "published.registration";
  std::vector<PublishedScores::Registration> rows;
  for (const auto& [sequence, variants] : object_in(json, place).items()) {
    for (const auto& [variant, values] : object_in(variants, place + "." + sequence).items()) {
      const std::string below = fmt::format("{}.{}.{}", place, sequence, variant);
      if (variant != "prefusion" && variant != "normal" && variant != "regularized") {
        throw UsageError(fmt::format("{}: variants are prefusion, normal, regularized", below));
      }
      PublishedScores::Registration row{sequence, variant, {}};
      require_keys(values, below, {"rmse", "average_wasserstein", "chamfer", "spatial_consistency"});
      for (const auto& [id, value] : values.items()) row.values[id] = number_or_null(value, below + "." + id);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace

PublishedScores parse_published(const Json& json) {
  require_keys(json, "published", {"source", "metrics", "registration", "color_distance_scale", "notes"});
  PublishedScores published;
  published.source = text_in(required(json, "published", "source"), "published.source");
  if (json.contains("metrics")) {
    for (const auto& [id, sequences] : object_in(json.at("metrics"), "published.metrics").items()) {
      published.metrics.push_back(metric_in(id, sequences));
    }
  }
  if (json.contains("registration")) published.registration = registration_in(json.at("registration"));
  if (json.contains("color_distance_scale")) {
    const std::string place = "published.color_distance_scale";
    for (const auto& [sequence, value] : object_in(json.at("color_distance_scale"), place).items()) {
      const std::optional<double> scale = number_or_null(value, place + "." + sequence);
      if (!scale || *scale <= 0.0) throw UsageError(fmt::format("{}.{}: must be above 0", place, sequence));
      published.color_scale[sequence] = *scale;
    }
  }
  if (json.contains("notes")) {
    for (const Json& note : list_in(json.at("notes"), "published.notes")) {
      published.notes.push_back(text_in(note, "published.notes"));
    }
  }
  return published;
}

}  // namespace cmap
