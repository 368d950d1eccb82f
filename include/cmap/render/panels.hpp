#pragma once

#include "cmap/render/legend.hpp"

namespace cmap {

/// The picture of panel i of n; its title stands above and its legend below.
Rect panel_place(std::size_t i, std::size_t n, const FigureOptions& options);

/// What all panels of a figure are written with.
Pen panel_pen(std::size_t n_panels, const FigureOptions& options);

}  // namespace cmap
