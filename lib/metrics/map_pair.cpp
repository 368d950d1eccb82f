#include "cmap/metrics/map_pair.hpp"

namespace cmap {

PointCloud cloud_of(const IndexedMap& map) {
  const PointBlocks& points = map.index.points;
  PointCloud cloud;
  cloud.origin = points.origin;
  cloud.positions.resize(points.size);
  Array<Rgb8> colors(map.has_color() ? points.size : 0);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    const std::uint32_t i = points.original_index[slot];
    cloud.positions[i] = points.offset(slot);
    if (map.has_color()) colors[i] = to_rgb8(color_at(map.colors, slot));
  }
  if (map.has_color()) cloud.colors = std::move(colors);
  return cloud;
}

}  // namespace cmap
