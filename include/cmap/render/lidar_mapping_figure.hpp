#pragma once

#include "cmap/lio/lidar_mapping.hpp"
#include "cmap/render/image.hpp"

namespace cmap {

/// A picture of the map from above, by height, with the path over it: dark where scans were registered, red where
/// prediction alone placed them; loops are green lines. The same bytes for any number of threads.
Image draw_lidar_mapping(const LidarMapping& mapping);

}  // namespace cmap
