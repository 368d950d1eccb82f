#pragma once

#include "cmap/eval/evaluation.hpp"
#include "cmap/io/trajectory_file.hpp"

namespace cmap {

/// What the comparison of a pair starts from.
struct ProtocolInputs {
  Eigen::Matrix4d T_initial = Eigen::Matrix4d::Identity();  ///< ref from est: as given, or where the alignment begins
  std::optional<Trajectory> reference_trajectory = {};      ///< for align = trajectory
  std::optional<Trajectory> estimate_trajectory = {};
  /// Where the estimate's sensor was, for observed = sensor; in the estimate's frame, and moved with the estimate.
  std::vector<Eigen::Vector3d> sensor_positions = {};
  std::vector<Warning> warnings = {};  ///< of what was read; they come first among the evaluation's
};

/// The whole comparison as the options say: the scores before, the alignment, the band of small motions, the
/// evaluation. Throws as align(), require_trust() and evaluate() do; UsageError where align = trajectory and a trajectory is missing.
EvaluatedPair evaluate_by_protocol(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                                   const ProtocolInputs& inputs = {}, const Execution& execution = {});

}  // namespace cmap
