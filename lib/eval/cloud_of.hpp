#pragma once

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// The map in its own order; colors as 8 bit.
PointCloud cloud_of(const IndexedMap& map);

}  // namespace cmap
