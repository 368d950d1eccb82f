#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cmap/core/enum_names.hpp"

namespace cmap {

/// What a voxel of one point, whose colors cannot scatter, counts as in color consistency.
enum class Singletons {
  kZero,     ///< 0, and every occupied voxel is in the mean, as in the authors' tool
  kExclude,  ///< nothing: voxels of fewer than min_points points are left out
  kRefuse,   ///< there must be none
};

/// "zero", "exclude", "refuse".
const EnumNames<Singletons>& singletons_names();

/// How many grids of voxels are evaluated, each shifted by parts of a voxel: so many parts on each axis.
enum class GridPhases { kOne = 1, kEight = 2, kTwentySeven = 3 };

/// "1", "8", "27".
const EnumNames<GridPhases>& grid_phases_names();

/// The parameters of the metrics; the defaults are those of METRICS, the paper's where it gives any.
struct MetricOptions {
  std::vector<double> thresholds_m{0.2, 0.1, 0.08, 0.05, 0.01};
  double overlap_distance_m = 1.0;
  double lcr_tau = 0.1;
  double lcr_radius_m = 0.5;
  bool lcr_curve = false;
  double ccs_voxel_m = 0.1;
  Singletons ccs_singletons = Singletons::kZero;
  std::uint64_t ccs_min_points = 2;
  bool ccs_phases = false;
  double cw_voxel_m = 1.0;
  std::uint64_t cw_min_points = 10;
  double awd_voxel_m = 3.0;
  std::uint64_t awd_min_points = 100;
  std::uint64_t scs_radius_voxels = 5;
  double mme_radius_m = 0.1;
  std::uint64_t mme_min_neighbors = 10;
  std::optional<double> color_max_distance_m;
  GridPhases grid_phases = GridPhases::kEight;
  bool no_levels = false;  ///< no floor, chance and skill
};

}  // namespace cmap
