#pragma once

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// The clouds as they are compared: estimate moved by T_ref_est, both cropped and thinned as the options say, both on
/// one origin unless they are farther apart than 10 km. Appends warnings about frames and precision.
/// Throws InputError for an empty cloud or a non-finite point, UnsupportedError where the crop leaves nothing.
void prepare_clouds(PointCloud& reference, PointCloud& estimate, const EvaluationOptions& options,
                    const MetricSelection& selection, const Eigen::Matrix4d& T_ref_est, std::vector<Warning>& warnings);

}  // namespace cmap
