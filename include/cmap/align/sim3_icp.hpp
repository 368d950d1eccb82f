#pragma once

#include <span>

#include "cmap/align/alignment.hpp"
#include "cmap/align/robust_kernel.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Scale-estimating ICP with an expected scale, the post-fusion stage of the LiDAR-VGGT paper: each iteration minimizes
///   sum_i w_i |q_i - (s R p_i + t)|^2 + lambda (s - s0)^2,  lambda = beta n D^2,
/// over the nearest pairs in closed form (umeyama.hpp); s0 is the scale of the initial transform, n the points of the
/// thinned source, D its size in its own units. beta and the gate go geometrically from their first to their last value
/// over the annealed iterations.
struct Sim3IcpOptions {
  double voxel_m = 0.2;    ///< of the thinned source, in the target's units; the target's is half; 0: as they are
  double beta0 = 0.1;      ///< strength of the expectation at first: 0.1 takes 45 % of a step, 1 takes 8 %
  double beta1 = 1e-4;     ///< at the end
  double gate0_m = 2.0;    ///< farther pairs are no matches, at first; infinity is possible
  double gate1_m = 0.6;    ///< at the end
  bool crop = true;        ///< only source points inside the target's box and its occupied cells count
  double crop_cell = 5.0;  ///< side of these cells, in voxels
  RobustKernel kernel = RobustKernel::kCauchy;
  double kernel_width = 0.5;   ///< scale of the kernel as a share of the gate
  bool size_from_box = false;  ///< D is the diagonal of the source's box; else sqrt(12 mean |p~|^2), blind to strays
  int iterations = 60;
  int annealed_iterations = 36;  ///< of these; afterwards it may stop early
  std::size_t min_matches = 100;
  double min_overlap = 0.1;
  double min_scale = 0.8, max_scale = 1.25;  ///< of the result over s0; outside: a warning
  int neighbors = 10;                        ///< for the normals that the condition is computed from, 5..64

  /// The default: shrinking gate from max(10 voxels, 3 sigma) to 3 voxels, crop, annealed beta, Cauchy weights.
  static Sim3IcpOptions robust(double voxel_m, double sigma_m = 0.0);
  /// As printed in the paper: constant beta 0.1, constant gate of 10 voxels, no crop, no weights, D from the box.
  static Sim3IcpOptions paper(double voxel_m);
  /// What the paper compares with: the same with beta = 0.
  static Sim3IcpOptions normal(double voxel_m);
};

/// Throws UsageError naming the field, its value and the rule it breaks.
void check_options(const Sim3IcpOptions& options);

struct Sim3Alignment : Alignment {
  /// False where fewer than min_matches or min_overlap are left, or the geometry leaves a direction free: then
  /// T_dst_src is the initial transform, and the last warning says why.
  bool accepted = true;
};

/// Moves the source onto the target from T_initial (a similarity; world frames). `weights`: of the source's points, for
/// example confidences, relative to each other; empty: all equal; thinned by their mean. Thread-safe; bitwise the same
/// for any number of threads. Throws UnsupportedError where T_initial is no similarity, UsageError for options,
/// std::invalid_argument on empty clouds or wrong weights.
Sim3Alignment sim3_icp(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
                       const Sim3IcpOptions& options, std::span<const float> weights = {});

}  // namespace cmap
