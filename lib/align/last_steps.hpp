#pragma once

#include "cmap/align/align.hpp"

namespace cmap {

/// Thinning leaves an error of some share of the voxel. Where both clouds hold the same points, as a copy does, the
/// points themselves leave none: they are tried, and taken where they come to lie on each other. Returns whether.
bool settle_on_common_points(const PointCloud& source, const PointCloud& target, bool with_scale, Alignment& found);

/// Goes on from what was found to levels of this voxel. A step that leads away from what was judged is not taken.
void sharpen(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method, bool with_scale,
             double voxel_m, Alignment& found);

}  // namespace cmap
