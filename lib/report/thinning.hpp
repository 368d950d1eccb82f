#pragma once

#include "cmap/spatial/point_blocks.hpp"

namespace cmap {

/// Slots of about `n_wanted` points that are spread evenly over the map's surfaces, ascending; all slots where the map
/// has no more. Every block of neighboring points gives as many as its share of the whole surface.
Array<std::uint32_t> evenly_spread_slots(const PointBlocks& points, std::size_t n_wanted);

}  // namespace cmap
