#pragma once

#include <string>

namespace cmap {

/// Why a principal point is not that of a picture of this size: it lies outside the middle half of the picture's width
/// or height, as that of another size does. Empty: it may well be.
std::string principal_point_doubt(double cx, double cy, int width, int height);

}  // namespace cmap
