#pragma once

#include <algorithm>

#include "cmap/render/figure.hpp"

namespace cmap {

struct Rect {
  int x, y, width, height;
};

/// How the writing around a picture is drawn: its lengths are for a panel of 800 x 500 pixels and grow with the panel.
struct Pen {
  Rgba8 ink;
  double unit;

  int px(double length) const { return std::max(1, static_cast<int>(length * unit + 0.5)); }
  int text_px() const { return px(18); }
  int small_text_px() const { return px(14); }
};

/// Height of what stands above and below a picture, in the pen's units.
inline constexpr double kTitleHeight = 32.0, kLegendHeight = 46.0;

/// Title at the left and caption at the right above the picture.
void draw_title(Image& image, const Rect& place, const Layer& layer, const Pen& pen);

/// What the layer's colors mean, below the picture: nothing for a map's own colors.
void draw_legend(Image& image, const Rect& place, const Layer& layer, const Pen& pen);

/// A bar in the picture's lower left corner that is `meters_per_px` true.
void draw_scale_bar(Image& image, const Rect& place, double meters_per_px, const Pen& pen);

}  // namespace cmap
