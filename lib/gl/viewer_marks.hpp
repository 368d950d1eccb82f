#pragma once

#include <span>
#include <string>

#include "cmap/render/legend.hpp"

namespace cmap {

/// Lines of text on a box that covers what is below, its upper left (kLeft) or upper right corner at (x, y).
void draw_text_box(Image& image, int x, int y, TextAnchor anchor, std::span<const std::string> lines, const Pen& pen);

/// A ring about a pixel that shows on any color.
void draw_ring(Image& image, int x, int y, const Pen& pen);

}  // namespace cmap
