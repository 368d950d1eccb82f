#include "preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/eval/map_error.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/geometry/point_extent.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "plausibility.hpp"

namespace cmap {
namespace {

void require_finite_points(const PointCloud& cloud, const char* which) {
  if (cloud.positions.empty()) throw InputError(fmt::format("the {} has no points", which));
  std::atomic<bool> finite = true;
  parallel_chunks(cloud.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    if (!point_extent(cloud.positions[begin].data(), end - begin).finite) finite = false;
  });
  if (!finite) throw InputError(fmt::format("the {} has a point that is not finite", which));
}

bool countable(const Box3d& box, double size_m) {
  try {
    const VoxelFrame frame(box, size_m);
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

/// One map, and the points of it that matter to its size.
struct Shape {
  const PointCloud& cloud;
  CloudBody body;
  const char* which;
};

/// Voxels that cannot be counted are refused before the work, and the blame goes where it belongs: to the points that
/// stretch the map, to the map where the size is the default, or to the option.
void check_voxels(const char* option, double size_m, double default_m, const Shape& map) {
  const Box3d& box = map.body.all;
  if (countable(box, size_m)) return;
  if (map.body.n_strays > 0 && countable(map.body.box, size_m)) {
    const Eigen::Vector3d x = map.cloud.world(map.body.farthest);
    throw MapError(
        map.which,
        fmt::format("point {} of {}, at ({:.10g}, {:.10g}, {:.10g}), lies {:.4g} m from nearly all others, too "
                    "far to count voxels up to it; leave out such points, {} here, as with --crop",
                    map.body.farthest + 1, map.cloud.size(), x.x(), x.y(), x.z(), map.body.farthest_m,
                    map.body.n_strays));
  }
  if (size_m == default_m) {
    throw MapError(map.which,
                   fmt::format("the points span {:.4g} m, too much to count voxels of {} m: are they in meters?",
                               (box.max - box.min).maxCoeff(), size_m));
  }
  try {
    const VoxelFrame frame(box, size_m);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", option, error.what()));
  }
}

void check_voxels_of_metrics(const EvaluationOptions& options, const MetricSelection& selection, const Shape& map) {
  const EvaluationOptions defaults;
  if (selection.contains("color_consistency") && map.cloud.has_color()) {
    check_voxels("ccs-voxel", options.ccs_voxel_m, defaults.ccs_voxel_m, map);
  }
  if (selection.contains("color_wasserstein") && map.cloud.has_color()) {
    check_voxels("cw-voxel", options.cw_voxel_m, defaults.cw_voxel_m, map);
  }
  if (options.bootstrap > 0) check_voxels("block", options.block_m, 0.0, map);
  if (selection.needs_gaussians) check_voxels("awd-voxel", options.awd_voxel_m, defaults.awd_voxel_m, map);
}

void crop_and_thin(PointCloud& cloud, const EvaluationOptions& options, const char* which) {
  if (options.crop) {
    cloud = crop(cloud, *options.crop);
    if (cloud.positions.empty()) throw UnsupportedError(fmt::format("crop: no point of the {} is inside", which));
  }
  if (options.voxel_m) {
    check_voxels("voxel", *options.voxel_m, 0.0, {cloud, body_of(cloud), which});
    cloud = voxel_thinned(cloud, *options.voxel_m);
  }
}

/// By a transform that leaves the map where a map can be: readers take no coordinate as far.
PointCloud moved(const PointCloud& cloud, const Eigen::Matrix4d& T) {
  constexpr double kFarthest_m = 1e9;
  PointCloud result = transformed(cloud, T);
  const Box3d box = bounds(result);
  const double farthest_m = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (!(farthest_m < kFarthest_m)) {
    throw UnsupportedError(fmt::format(
        "the transform moves the estimate to coordinates of {:.3g} m: is it T_ref_est, in meters?", farthest_m));
  }
  return result;
}

/// Moves a cloud's origin; offsets are rounded to float.
void rebase(PointCloud& cloud, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d shift = cloud.origin - origin;
  if (shift.isZero(0.0)) return;
  for (Eigen::Vector3f& p : cloud.positions) p = (p.cast<double>() + shift).cast<float>();
  cloud.origin = origin;
}

}  // namespace

void drop_missing_colors(PointCloud& cloud) {
  if (cloud.has_color() && count_without_color(cloud.colors) == cloud.size()) cloud.colors = {};
}

CoordinateSteps prepare_clouds(PointCloud& reference, PointCloud& estimate, const EvaluationOptions& options,
                               const MetricSelection& selection, const Eigen::Matrix4d& T_ref_est,
                               std::vector<Warning>& warnings) {
  require_finite_points(reference, "reference");
  require_finite_points(estimate, "estimate");
  const double finest_m = finest_step_needed_m(options);
  const CoordinateSteps steps{coarse_step(reference, finest_m), coarse_step(estimate, finest_m)};
  if (T_ref_est != Eigen::Matrix4d::Identity()) estimate = moved(estimate, T_ref_est);
  crop_and_thin(reference, options, "reference");
  crop_and_thin(estimate, options, "estimate");

  const CloudBody reference_body = body_of(reference), estimate_body = body_of(estimate);
  check_voxels_of_metrics(options, selection, {reference, reference_body, "reference"});
  check_voxels_of_metrics(options, selection, {estimate, estimate_body, "estimate"});
  warn_about_frames(reference_body, estimate_body, warnings);
  const Box3d &a = reference_body.box, &b = estimate_body.box;
  if (gap_between(a, b) <= kFarApart_m) {
    const Eigen::Vector3d origin = choose_origin(united(a, b));
    rebase(reference, origin);
    rebase(estimate, origin);
  }
  return steps;
}

std::optional<CoordinateStep> prepare_map(PointCloud& map, const EvaluationOptions& options,
                                          const MetricSelection& selection) {
  require_finite_points(map, "map");
  const auto step = coarse_step(map, finest_step_needed_m(options));
  crop_and_thin(map, options, "map");
  check_voxels_of_metrics(options, selection, {map, body_of(map), "map"});
  return step;
}

}  // namespace cmap
