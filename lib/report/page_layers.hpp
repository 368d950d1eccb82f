#pragma once

#include <nlohmann/json.hpp>

#include "cmap/metrics/local_color_recall.hpp"
#include "distribution.hpp"

namespace cmap {

// The layers of a report's page: how the points of a map may be colored, and what the legend says of it
// (lib/report/web/src/contract.ts). Shares in legends are of all points of the map, as in the metrics, though the page
// holds only some of a large one.

/// A map's own colors, or its height where it has none.
nlohmann::ordered_json map_layer(const IndexedMap& map, const char* map_id, const char* title);
nlohmann::ordered_json height_layer(const IndexedMap& map, const char* map_id, const char* title);

/// Errors of the estimate's points.
nlohmann::ordered_json distance_layer(const Distribution& distances);
nlohmann::ordered_json color_distance_layer(const Distribution& color_distances);

nlohmann::ordered_json recall_layer(const LocalColorRecall& recall);

}  // namespace cmap
