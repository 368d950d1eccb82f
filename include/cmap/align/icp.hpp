#pragma once

#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/align/robust_kernel.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// What is minimized over the nearest pairs (p moved source point, q target point):
enum class IcpMetric {
  kPoint,  ///< |p - q|^2: Besl and McKay 1992; closed-form steps
  kPlane,  ///< (n . (p - q))^2, n the target's normal: Chen and Medioni 1992; Gauss-Newton steps
  kGicp,   ///< (p - q)^T (C_q + R C_p R^T)^-1 (p - q), C = I - (1 - 1e-3) n n^T: Segal, Haehnel and Thrun 2009
};

/// One level of a coarse-to-fine schedule.
struct IcpLevel {
  double voxel_m = 0.0;         ///< of the thinned source, in the target's units; the target's is half; 0: as they are
  double max_distance_m = 1.0;  ///< farther pairs are no matches
  int max_iterations = 50;
  std::size_t most_points = 0;  ///< of the thinned source that take part, spread evenly; 0: all
};

struct IcpOptions {
  IcpMetric metric = IcpMetric::kGicp;
  bool with_scale = false;  ///< Sim(3) in place of SE(3); else the scale of the initial transform is kept
  std::vector<IcpLevel> levels = std::vector<IcpLevel>(1);
  RobustKernel kernel = RobustKernel::kCauchy;
  double kernel_width = 0.1;  ///< scale of the kernel as a share of max_distance_m
  int neighbors = 10;         ///< points that a normal is fitted to; more: smoother, 5..64
  /// A level ends when a step turns by less and moves its center by less, as a share of the voxel (of max_distance_m /
  /// 4 where not thinned), and scales by less.
  double min_rotation_rad = 1e-5;
  double min_translation_voxels = 5e-4;
  double min_scale = 1e-6;
};

/// Throws UsageError naming the field, its value and the rule it breaks.
void check_options(const IcpOptions& options);

/// Levels for a final voxel and distance: voxels 4, 2, 1 times the final one, distances likewise.
std::vector<IcpLevel> coarse_to_fine(double voxel_m, double max_distance_m, int max_iterations = 50);

/// Iterative closest points from T_initial (dst from src, world frames). Steps are solved about the source's center, in
/// local coordinates, and directions that the data do not determine are left alone; clouds may lie anywhere (UTM).
/// Thread-safe; bitwise the same for any number of threads and every instruction set.
/// Throws UnsupportedError where the result cannot be determined: fewer than 3 matches (no overlap), coincident or
/// collinear points, a surface that slides in itself (plane, sphere, cylinder), saying which direction is free;
/// std::invalid_argument on an empty cloud.
Alignment icp(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
              const IcpOptions& options);

}  // namespace cmap
