#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_options.hpp"

namespace cmap {

/// World index of a voxel: floor(world / voxel_m) per axis.
using VoxelIndex = std::array<std::int64_t, 3>;

/// The points of one voxel as a Gaussian, meters.
struct Gaussian {
  std::uint64_t n = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< sum (x - mean)(x - mean)^T
  Eigen::Matrix3d covariance() const { return scatter / static_cast<double>(n - 1); }
};

/// A voxel that holds at least the asked number of points of both maps. Means are relative to the voxel's corner.
struct GaussianPair {
  VoxelIndex index;
  Gaussian reference;
  Gaussian estimate;
};

struct VoxelDistance {
  VoxelIndex index;
  double distance_m;
};

/// The Wasserstein distances of the voxels that hold enough points of both maps, of one grid of voxels and of those
/// shifted by parts of a voxel ("Levels" of METRICS).
struct VoxelWasserstein {
  std::vector<GaussianPair> gaussians;               ///< of the grid at the world's origin, ordered by index
  std::vector<std::vector<VoxelDistance>> by_phase;  ///< x slowest; the first is of `gaussians`; ordered by index
  std::vector<double> of_halves;  ///< those between two random halves of the reference, if asked for; in any order
};

/// How a grid is evaluated.
struct PhaseOptions {
  double voxel_m = 1.0;
  std::uint64_t min_points = 2;  ///< of each map
  int parts_per_axis = 1;        ///< 1: the grid at the world's origin alone; 2 or 3: 8 or 27 phases
  bool halves = false;
};

/// Of a metric of voxels, as the options say.
inline PhaseOptions phase_options(const MetricOptions& options, double voxel_m, std::uint64_t min_points) {
  return {voxel_m, min_points, static_cast<int>(options.grid_phases), !options.no_levels};
}

/// In one pass over the points. Throws UsageError for voxels too small to be counted. The same bits for any number of
/// threads and any order of the points (but for the halves, which the original index decides).
VoxelWasserstein voxel_wasserstein(const MapPair& pair, const PhaseOptions& options);

/// The voxels of both maps with at least min_points (and 2) points each, ordered by index. Throws UsageError for voxels
/// too small to be counted. Deterministic, and the same bits for any order of the points.
std::vector<GaussianPair> gaussian_pairs(const MapPair& pair, double voxel_m, std::uint64_t min_points);

/// 2-Wasserstein distance (m) of two Gaussians with at least 2 points each:
/// W^2 = |m1 - m2|^2 + tr(S1 + S2 - 2 (S1^1/2 S2 S1^1/2)^1/2), covariances with n - 1. A W^2 below
/// 1e-12 (tr S1 + tr S2) is rounding noise and counts as 0.
double wasserstein_distance(const Gaussian& a, const Gaussian& b);

/// Their mean, NaN of none.
double mean_distance(std::span<const VoxelDistance> voxels);

/// What spatial consistency SCS averages: around every voxel the coefficient of variation (population standard
/// deviation / mean) of the distances of the other voxels within +- radius_voxels on every axis. NaN for voxels without
/// others, or whose others' mean is 0. The voxels must be ordered by index.
std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels);

/// The mean of those that are not NaN, NaN of none.
double mean_variation(std::span<const double> variations);

}  // namespace cmap
