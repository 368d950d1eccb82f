#pragma once

#include "cmap/eval/evaluation.hpp"
#include "coordinate_step.hpp"

namespace cmap {

/// Colors that no point has are none.
void drop_missing_colors(PointCloud& cloud);

/// The coarse steps of both maps' coordinates before they were moved, where there are any.
struct CoordinateSteps {
  std::optional<CoordinateStep> reference;
  std::optional<CoordinateStep> estimate;
};

/// The clouds as they are compared: estimate moved by T_ref_est, both cropped and thinned as the options say, both on
/// one origin unless they are farther apart than 10 km. Appends warnings about sizes and frames.
/// Throws InputError for an empty cloud or a non-finite point, UnsupportedError where the crop leaves nothing; for
/// voxels that cannot be counted MapError if the map is to blame, UsageError if the option is.
CoordinateSteps prepare_clouds(PointCloud& reference, PointCloud& estimate, const EvaluationOptions& options,
                               const MetricSelection& selection, const Eigen::Matrix4d& T_ref_est,
                               std::vector<Warning>& warnings);

/// The same for one map without a reference, which keeps its origin; its coarse step.
std::optional<CoordinateStep> prepare_map(PointCloud& map, const EvaluationOptions& options,
                                          const MetricSelection& selection);

}  // namespace cmap
