#pragma once

#include <span>

#include "cmap/align/pose_pairs.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/align/verdict.hpp"

namespace cmap {

/// What is to be said of T, which was fitted to these pairs of poses (those that do not fit left out):
/// - mirrored: a reflection leaves less than half of the residual;
/// - unsupported: RMSE above half of the target's spread about its mean, or less than 60 % of the squared displacements
///   between 21 poses along the path explained by one similarity: as paths that have nothing to do with each other;
/// - unsupported: a spread across the path's main direction below 2 residuals leaves the rotation about it to noise;
///   below 3 it is weak, the standard error from the residuals as far as they are independent of each other;
/// - determined.
/// The score is the share of the target's squared spread that T explains. Of 2000 simulated pairs of unrelated paths
/// (smooth, random walks, cars, handheld) all are unsupported; of the five published estimates of KITTI 07 and NTU
/// VIRAL none is.
Judgment judge_paths(std::span<const PosePair> pairs, const Similarity& T, TrajectoryFit fit);

}  // namespace cmap
