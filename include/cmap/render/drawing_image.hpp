#pragma once

#include "cmap/core/drawing.hpp"
#include "cmap/render/image.hpp"

namespace cmap {

/// The drawing on white, `scale` pixels for each of its own.
Image image_of(const Drawing& drawing, double scale);

}  // namespace cmap
