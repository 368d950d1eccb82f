#include "page_layers.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "cmap/core/parallel.hpp"
#include "cmap/core/round_number.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Enough digits to tell values apart, and 0.1 for what single precision makes of it.
double seven_digits(double value) { return std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr); }

Json scalar_layer(const std::string& id, const char* map_id, const char* title, const char* field,
                  const char* color_map, std::array<double, 2> range, const char* unit, const RankedValues& ranked) {
  Json values = Json::array();
  for (double value : ranked.values) values.push_back(seven_digits(value));
  return {{"id", id},         {"title", title}, {"map", map_id},
          {"kind", "scalar"}, {"field", field}, {"color_map", color_map},
          {"range", range},   {"unit", unit},   {"ranked", {{"points", ranked.n}, {"values", values}}}};
}

std::array<double, 2> error_range(const Distribution& errors) {
  return {0.0, round_number_above(errors.estimate_to_reference.p95)};
}

}  // namespace

Json map_layer(const IndexedMap& map, const char* map_id, const char* title) {
  if (!map.has_color()) return height_layer(map, map_id, title);
  return {{"id", map_id}, {"title", title}, {"map", map_id}, {"kind", "color"}};
}

Json height_layer(const IndexedMap& map, const char* map_id, const char* title) {
  const PointBlocks& points = map.index.points;
  Array<double> heights(points.size);
  parallel_chunks(points.size, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) heights[slot] = points.world(slot).z();
  });
  const RankedValues all = ranked(heights);
  const auto at = [&](double share) {
    return all.values[static_cast<std::size_t>(share * static_cast<double>(all.values.size() - 1))];
  };
  const double low = at(0.01), high = at(0.99);
  return scalar_layer(fmt::format("{}-height", map_id), map_id, title, "z", "viridis",
                      {low, high > low ? high : low + 1.0}, "m", all);
}

Json distance_layer(const Distribution& distances) {
  return scalar_layer("distance", "estimate", "Distance to the reference", "distance", "viridis",
                      error_range(distances), "m", distances.ranked_estimate);
}

Json color_distance_layer(const Distribution& color_distances) {
  return scalar_layer("color-distance", "estimate", "Color distance", "color_distance", "inferno",
                      error_range(color_distances), "unit RGB", color_distances.ranked_estimate);
}

/// Shares are the metric's: of the points that have a color.
Json recall_layer(const LocalColorRecall& recall) {
  std::array<std::uint64_t, kRecallClassLooks.size()> n{};
  for (RecallClass c : recall.classes) ++n[static_cast<std::size_t>(c)];
  const std::uint64_t n_colored = recall.classes.size() - n[static_cast<std::size_t>(RecallClass::kNoColor)];
  Json classes = Json::array();
  for (std::size_t c = 0; c < n.size(); ++c) {
    const bool counts = static_cast<RecallClass>(c) != RecallClass::kNoColor;
    if (!counts && n[c] == 0) continue;
    const RecallClassLook& look = kRecallClassLooks[c];
    const Json share = counts ? Json(static_cast<double>(n[c]) / static_cast<double>(n_colored)) : Json();
    classes.push_back({{"label", look.label},
                       {"color", {look.color[0], look.color[1], look.color[2]}},
                       {"points", n[c]},
                       {"share", share}});
  }
  return {{"id", "lcr"},        {"title", "Local color recall"},
          {"map", "reference"}, {"kind", "classes"},
          {"field", "lcr"},     {"classes", classes}};
}

}  // namespace cmap
