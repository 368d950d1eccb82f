#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// A map as the page of a report unpacks it (lib/report/web/src/data.ts): `description` tells which planes of values
/// follow each other in `bytes`. A plane has one value for each point, coded as the difference to the point before,
/// zig-zag, and split into one run for each of its bytes, low ones first: neighbors are alike, so that gzip finds
/// little left. Positions are counted in the steps of `grids`, that of the map and, after it, that of its strays
/// (points farther from its core than ten of its diagonals): strays come last. Errors are stored as the square root of
/// their share of the largest of the map, or of its strays; 65535 is none.
struct PackedMap {
  nlohmann::ordered_json description;
  std::string bytes;
};

/// The points in `slots` of pairs.from with their color and errors; `recall` is null where there is none.
PackedMap pack_map(const NearestPairs& pairs, const LocalColorRecall* recall, const Array<std::uint32_t>& slots);

/// The points in `slots` of one map with their color.
PackedMap pack_map(const IndexedMap& map, const Array<std::uint32_t>& slots);

}  // namespace cmap
