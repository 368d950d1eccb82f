#pragma once

#include <string>
#include <vector>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// What is known of one point of a map: where it is and its color, a line each.
std::vector<std::string> describe_point(const IndexedMap& map, std::size_t slot);

/// The same of a point of either map of a pair, and how it compares with the other map: distance, color distance, and
/// local color recall where it was computed. `points` must be one of the pair's.
std::vector<std::string> describe_point(const EvaluatedPair& evaluation, const PointBlocks& points, std::size_t slot);

}  // namespace cmap
