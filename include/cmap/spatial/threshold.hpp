#pragma once

namespace cmap {

struct Bvh;

// Thresholds mean what was typed (METRICS). Offsets are held as floats, so that points exactly 0.1 m apart in a file
// may come out a little farther: a distance up to kThresholdSteps steps of float above a threshold, at the largest
// absolute coordinate of both points' offsets, counts as at it.

inline constexpr double kThresholdSteps = 2.0;

/// The step from |offset| to the next larger float.
double float_step(float offset);

/// The largest absolute coordinate of any of the points' offsets.
float largest_offset(const Bvh& points);

/// Whether a distance is at most the threshold and `steps` float steps at the offset.
bool is_within(double sq_dist, double threshold_m, double steps, float largest_offset);

}  // namespace cmap
