#include "eval/preparation.hpp"

#include <fmt/format.h>

#include <atomic>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/spatial/voxel_map.hpp"

namespace cmap {
namespace {

constexpr double kFarApart_m = 1e4;
constexpr double kDifferentUnits = 100.0;

void require_finite_points(const PointCloud& cloud, const char* which) {
  if (cloud.positions.empty()) throw InputError(fmt::format("the {} has no points", which));
  std::atomic<bool> finite = true;
  parallel_chunks(cloud.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!cloud.positions[i].allFinite()) finite = false;
    }
  });
  if (!finite) throw InputError(fmt::format("the {} has a point that is not finite", which));
}

/// Voxels too small to be counted are refused by the option's name, and before the work.
void check_voxels(const char* option, double size_m, const Box3d& box) {
  try {
    const VoxelFrame countable(box, size_m);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", option, error.what()));
  }
}

void check_voxels_of_metrics(const EvaluationOptions& options, const MetricSelection& selection, const Box3d& box) {
  if (selection.contains("color_consistency")) check_voxels("ccs-voxel", options.ccs_voxel_m, box);
  if (selection.needs_gaussians) check_voxels("awd-voxel", options.awd_voxel_m, box);
}

void crop_and_thin(PointCloud& cloud, const EvaluationOptions& options, const char* which) {
  if (options.crop) {
    cloud = crop(cloud, *options.crop);
    if (cloud.positions.empty()) throw UnsupportedError(fmt::format("crop: no point of the {} is inside", which));
  }
  if (options.voxel_m) {
    check_voxels("voxel", *options.voxel_m, bounds(cloud));
    cloud = voxel_thinned(cloud, *options.voxel_m);
  }
}

double gap_between(const Box3d& a, const Box3d& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

void warn_about_frames(const Box3d& a, const Box3d& b, std::vector<Warning>& warnings) {
  const double size_a = (a.max - a.min).norm();
  const double size_b = (b.max - b.min).norm();
  const double gap = gap_between(a, b);
  if (gap > 0.0) {
    warnings.push_back({"units_or_frame_mismatch",
                        fmt::format("the maps' boxes are {:.4g} m apart: are both in the reference frame?", gap)});
  } else if (std::max(size_a, size_b) > kDifferentUnits * std::min(size_a, size_b)) {
    warnings.push_back(
        {"units_or_frame_mismatch",
         fmt::format("the reference spans {:.4g} m and the estimate {:.4g} m: are both in meters?", size_a, size_b)});
  }
  if (gap > kFarApart_m) {
    warnings.push_back(
        {"precision_reduced",
         fmt::format("the maps are {:.4g} km apart: distances are rounded to single precision there", gap / 1e3)});
  }
}

/// Moves a cloud's origin; offsets are rounded to float.
void rebase(PointCloud& cloud, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d shift = cloud.origin - origin;
  if (shift.isZero(0.0)) return;
  for (Eigen::Vector3f& p : cloud.positions) p = (p.cast<double>() + shift).cast<float>();
  cloud.origin = origin;
}

}  // namespace

void prepare_clouds(PointCloud& reference, PointCloud& estimate, const EvaluationOptions& options,
                    const MetricSelection& selection, const Eigen::Matrix4d& T_ref_est,
                    std::vector<Warning>& warnings) {
  require_finite_points(reference, "reference");
  require_finite_points(estimate, "estimate");
  if (T_ref_est != Eigen::Matrix4d::Identity()) estimate = transformed(estimate, T_ref_est);
  crop_and_thin(reference, options, "reference");
  crop_and_thin(estimate, options, "estimate");

  const Box3d reference_box = bounds(reference);
  const Box3d estimate_box = bounds(estimate);
  for (const Box3d& box : {reference_box, estimate_box}) check_voxels_of_metrics(options, selection, box);
  warn_about_frames(reference_box, estimate_box, warnings);
  if (gap_between(reference_box, estimate_box) <= kFarApart_m) {
    const Eigen::Vector3d origin =
        choose_origin({reference_box.min.cwiseMin(estimate_box.min), reference_box.max.cwiseMax(estimate_box.max)});
    rebase(reference, origin);
    rebase(estimate, origin);
  }
}

}  // namespace cmap
