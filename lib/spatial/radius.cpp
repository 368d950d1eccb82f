#include "cmap/spatial/radius.hpp"

#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "spatial/simd/kernels.hpp"

namespace cmap {
namespace {
constexpr std::size_t kQueryChunk = 256;
}

void lower_color_distance(const Bvh& index, const Array<ColorBlock>& index_colors, const BoxLevels& index_color_boxes,
                          const PointBlocks& queries, const Array<ColorBlock>& query_colors, const ColorSearch& search,
                          Array<float>& best) {
  // Whole blocks are read and written: the lanes after the last query are done before they begin.
  best.resize(queries.blocks.size() * kBlockSize, search.stop_at);
  const Queries moved{queries, queries.origin - index.points.origin};
  parallel_chunks(queries.blocks.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    kernels().lower_color_distance(index, index_colors, index_color_boxes, moved, query_colors, search, begin, end,
                                   best);
  });
  best.resize(queries.size);
}

NeighborhoodShape neighborhood_shapes(const Bvh& cloud, double radius_m) {
  if (!(radius_m > 0.0)) throw std::invalid_argument("neighborhood_shapes: the radius must be positive");
  NeighborhoodShape shape{Array<std::uint32_t>(cloud.points.size), Array<double>(cloud.points.size)};
  parallel_chunks(cloud.points.blocks.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    kernels().neighborhood_shapes(cloud, radius_m, begin, end, shape);
  });
  return shape;
}

}  // namespace cmap
