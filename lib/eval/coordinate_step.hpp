#pragma once

#include <optional>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// The steps in which a cloud's coordinates come.
struct CoordinateStep {
  enum class Cause {
    kFloat16,  ///< every coordinate is a float16 number
    kFloat32,  ///< every coordinate is a float32 number
    kGrid,    ///< another axis comes in the same steps, where floats have finer ones: a raster, the scale of a LAS file
    kDigits,  ///< every coordinate of the axis is a whole number of decimal steps, as after printing few digits
    kOwnOffsets  ///< the cloud is held as float32 offsets, and is too wide for them
  };
  double step_m = 0.0;
  int axis = 0;
  double coordinate = 0.0;  ///< of the largest magnitude there
  Cause cause = Cause::kFloat32;
};

/// The coarsest step above `limit_m`, judged from the numbers of at most 10,000 points, whatever type they were stored
/// as; none if they are finer. The cloud must be as it was read: a transform hides the steps of the file.
/// Single far points do not count.
std::optional<CoordinateStep> coarse_step(const PointCloud& cloud, double limit_m);

}  // namespace cmap
