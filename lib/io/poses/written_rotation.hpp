#pragma once

#include "cmap/geometry/rotation.hpp"

namespace cmap {

/// Written rotations may be this far from one (largest entry of R^T R - I) without a word.
inline constexpr double kRotationTolerance = 1e-3;

/// The last row of a matrix may be this far from 0 0 0 1: computed ones (an inverse, a product) miss it by some
/// roundings of single precision.
inline constexpr double kLastRowTolerance = 1e-6;

}  // namespace cmap
