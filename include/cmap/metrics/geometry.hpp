#pragma once

#include "cmap/metrics/distances.hpp"

namespace cmap {

/// Chamfer distance in its named variants (METRICS, "chamfer"), from the statistics of both directions; the truncated
/// one is capped where the statistics are.
struct Chamfer {
  double l1_sum;            ///< m: mean d(x^s, R) + mean d(x^r, S); the paper's CD#, MapEval's "FULL CD"
  double l1_mean;           ///< m: half of it
  double l2sq_sum;          ///< m^2: sum of both mean squared distances
  double l2_rms_mean;       ///< m: mean of both directions' RMS
  double truncated_l1_sum;  ///< m
};
Chamfer chamfer(const DistanceStats& estimate_to_reference, const DistanceStats& reference_to_estimate);

/// Harmonic mean 2PR / (P + R) of precision and recall; 0 when both are 0.
double f_score(double precision, double recall);

}  // namespace cmap
