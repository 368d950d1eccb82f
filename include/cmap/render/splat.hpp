#pragma once

#include "cmap/render/camera.hpp"

namespace cmap {

/// What every pixel of a picture shows: the nearest point and its depth.
struct PixelMap {
  int width = 0;
  int height = 0;
  Array<std::uint64_t> cells;  ///< row by row: bits of the float depth above the point's slot

  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

  bool is_empty(std::size_t cell) const { return cells[cell] == kEmpty; }
  std::uint32_t slot(std::size_t cell) const { return static_cast<std::uint32_t>(cells[cell]); }
  float depth_m(std::size_t cell) const;
};

struct SplatOptions {
  double point_size_m = 0.0;  ///< side of the square that stands for a point
  double min_size_px = 1.0;
  double max_size_px = 48.0;
};

/// Distance between neighboring points of a surface, typical for this map: what point_size_m is best a little above.
double typical_spacing_m(const PointBlocks& points);

/// Draws every point as a square facing the camera into a depth-and-slot buffer with an atomic minimum; equally near
/// points go to the lower slot. The same for any number of threads.
PixelMap splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options);

/// Shading by depth alone, after eye-dome lighting (Boucheny 2009): one factor in (0,1] for every pixel, darker the
/// farther it lies behind the middle of opposite neighbors, so that planes stay plain at any angle and edges and
/// hollows stand out; 1 where nothing is. `strength` 0 leaves all at 1.
Array<float> eye_dome_shading(const PixelMap& pixels, const Projection& projection, double strength);

}  // namespace cmap
