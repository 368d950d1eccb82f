#include "cmap/spatial/radius.hpp"

#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "simd/kernels.hpp"

namespace cmap {
namespace {
constexpr std::size_t kNeighborhoodChunk = 256;
}

Array<float> most_similar_color(const Bvh& index, const Array<ColorBlock>& index_colors, const PointBlocks& queries,
                                const Array<ColorBlock>& query_colors, const NearestField& nearest,
                                const ColorSearch& search) {
  Array<float> best(queries.size);
  const BoxLevels boxes = color_boxes(index_colors);
  const Queries moved{queries, queries.origin - index.points.origin};
  parallel_chunks(queries.blocks.size(), kNeighborhoodChunk, [&](std::size_t begin, std::size_t end) {
    kernels().most_similar_color({index, index_colors, boxes}, {moved, query_colors, nearest}, search, begin, end,
                                 best);
  });
  return best;
}

NeighborhoodShape neighborhood_shapes(const Bvh& cloud, double radius_m, double file_step_m) {
  if (!(radius_m > 0.0)) throw std::invalid_argument("neighborhood_shapes: the radius must be positive");
  const std::size_t n = cloud.points.size;
  NeighborhoodShape shape{Array<std::uint32_t>(n), Array<double>(n), Array<std::uint8_t>(n)};
  parallel_chunks(cloud.points.blocks.size(), kNeighborhoodChunk, [&](std::size_t begin, std::size_t end) {
    kernels().neighborhood_shapes(cloud, radius_m, file_step_m, begin, end, shape);
  });
  return shape;
}

}  // namespace cmap
