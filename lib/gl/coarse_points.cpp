#include "coarse_points.hpp"

#include <cmath>

#include "cmap/core/parallel.hpp"

namespace cmap {

CoarsePoints::CoarsePoints(const PointBlocks& points, std::size_t most)
    : all_(points), step_((points.size + most - 1) / most) {
  if (step_ <= 1) return;
  // Slots follow a space-filling curve: every n-th is an even selection.
  Array<std::uint32_t> slots((points.size + step_ - 1) / step_);
  for (std::size_t i = 0; i < slots.size(); ++i) slots[i] = static_cast<std::uint32_t>(i * step_);
  coarse_ = chosen_points(points, slots);
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
