#pragma once

#include "cmap/render/figure.hpp"

namespace cmap {

/// An even selection of a map's points, drawn somewhat larger: for pictures that must come fast.
class CoarsePoints {
 public:
  /// At most `most` points. `points` must stay alive.
  CoarsePoints(const PointBlocks& points, std::size_t most);

  /// What `splatter` finds, in slots of the whole map.
  PixelMap splat(const Splatter& splatter, const Projection& projection, const SplatOptions& options) const;

 private:
  const PointBlocks& all_;
  std::size_t step_;
  PointBlocks coarse_;  ///< every step_-th point; none where that is all
};

}  // namespace cmap
