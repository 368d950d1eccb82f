#include "gl/coarse_points.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/parallel.hpp"

namespace cmap {

CoarsePoints::CoarsePoints(const PointBlocks& points, std::size_t most)
    : all_(points), step_((points.size + most - 1) / most) {
  if (step_ <= 1) return;
  coarse_.origin = points.origin;
  coarse_.size = (points.size + step_ - 1) / step_;
  coarse_.blocks.resize((coarse_.size + kBlockSize - 1) / kBlockSize);
  // Slots follow a space-filling curve: every n-th is an even selection.
  for (std::size_t i = 0; i < coarse_.blocks.size() * kBlockSize; ++i) {
    const Eigen::Vector3f p = points.offset(std::min(i, coarse_.size - 1) * step_);
    PointBlock& block = coarse_.blocks[i / kBlockSize];
    block.x[i % kBlockSize] = p.x();
    block.y[i % kBlockSize] = p.y();
    block.z[i % kBlockSize] = p.z();
  }
}

PixelMap CoarsePoints::splat(const Splatter& splatter, const Projection& projection,
                             const SplatOptions& options) const {
  if (step_ <= 1) return splatter(all_, projection, options);
  SplatOptions larger = options;
  larger.point_size_m *= std::sqrt(static_cast<double>(step_));
  PixelMap pixels = splatter(coarse_, projection, larger);
  parallel_chunks(pixels.cells.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (!pixels.is_empty(cell)) pixels.cells[cell] += (step_ - 1) * pixels.slot(cell);
    }
  });
  return pixels;
}

}  // namespace cmap
