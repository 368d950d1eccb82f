#pragma once

#include <functional>
#include <span>

#include "cmap/render/image.hpp"
#include "cmap/render/layer.hpp"
#include "cmap/render/splat.hpp"

namespace cmap {

enum class Background { kWhite, kBlack, kTransparent };

/// Throws UsageError on an unknown name.
Background background_from_name(std::string_view name);

/// Finds what every pixel shows; see splat().
using Splatter = std::function<PixelMap(const PointBlocks&, const Projection&, const SplatOptions&)>;

struct FigureOptions {
  int width_px = 1600;
  int height_px = 1000;
  Background background = Background::kWhite;
  double point_size = 1.0;  ///< factor on the size that closes the gaps between points
  int samples = 2;          ///< along either axis of a pixel, averaged
  Splatter splatter = splat;
};

/// Largest width and height of a figure.
inline constexpr int kMostPixels = 16384;

/// Panels side by side, each with title, caption, what its colors mean, and a scale bar in meters; all from one camera.
/// Throws UsageError for sizes that leave no room or are above kMostPixels. The same bytes for any number of threads.
Image draw_figure(std::span<const Layer> layers, const Camera& camera, const FigureOptions& options);

/// Width / height of one panel's picture, for camera_for.
double panel_aspect(std::size_t n_layers, const FigureOptions& options);

}  // namespace cmap
