#pragma once

#include "cloud_body.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/eval/options.hpp"
#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/record.hpp"
#include "coordinate_step.hpp"

// What is probably wrong with the maps, said once each and never in the way: every check appends at most one warning a
// map, and costs a sample of the points or less. `which` is "reference", "estimate" or "map". The ids:
//   units_or_frame_mismatch  sizes that differ by a factor of 2.5, or boxes apart
//   coarse_coordinates       coordinates in steps above a tenth of the smallest threshold
//   precision_reduced        the same by our own float32 offsets: maps that are very wide, or far from one another
//   stray_points             a few points that decide RMSE or Chamfer
//   repeated_points          more than a hundredth of the points stand where another one stands
//   sparse_reference         thresholds below the spacing of the reference's points
//   shift_found              boxes apart, and an offset beside the file that brings them together (shift_warning.hpp)

namespace cmap {

/// Maps farther apart are compared in single precision, each about its own origin.
inline constexpr double kFarApart_m = 1e4;

/// Sizes and places of both maps in the reference frame.
void warn_about_frames(const CloudBody& reference, const CloudBody& estimate, std::vector<Warning>& warnings);

/// A tenth of the smallest threshold: coordinates must be finer.
double finest_step_needed_m(const EvaluationOptions& options);

/// A few points that decide RMSE (of the estimate) or a half of Chamfer (of either map).
void warn_about_strays(const MapPair& pair, const MeanDistances& estimate_to_reference,
                       const MeanDistances& reference_to_estimate, std::vector<Warning>& warnings);

/// How a map's points stand to one another, from at most 2,000 of them.
struct SampledSpacing {
  double spacing_m = 0.0;       ///< median distance to the nearest point elsewhere; NaN of fewer than 20
  double repeated_share = 0.0;  ///< of points at whose place another one stands
};
SampledSpacing sampled_spacing(const Bvh& index);

/// Steps of the coordinates and repeated points of one map; `step` is coarse_step() of the map as it was read.
/// A raster's steps are its spacing, and no matter of digits.
void warn_about_points(std::string_view which, const PointBlocks& points, const SampledSpacing& spacing,
                       const std::optional<CoordinateStep>& step, const EvaluationOptions& options,
                       std::vector<Warning>& warnings);

/// Thresholds below the reference's spacing that most of the estimate misses (`fitness` per threshold), where its
/// distances are such as that spacing alone would make them: not those of other errors, nor of an estimate with the
/// reference's own points.
void warn_about_spacing(const SampledSpacing& reference, const NearestField& nearest_in_reference,
                        std::span<const Record> fitness, std::vector<Warning>& warnings);

}  // namespace cmap
