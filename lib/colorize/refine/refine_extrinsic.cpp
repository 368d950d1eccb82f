#include "cmap/colorize/refine_extrinsic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/rotation.hpp"
#include "refine/told_directions.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestPoints = 100;
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The camera moved in its own frame by a turn and a shift.
Eigen::Isometry3d moved(const Eigen::Isometry3d& T_lidar_camera, const Vector6d& change) {
  Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
  by.linear() = rotation_from(change.head<3>());
  by.translation() = change.tail<3>();
  return T_lidar_camera * by;
}

/// Levenberg-Marquardt.
Eigen::Isometry3d minimized(const Agreement& agreement, Eigen::Isometry3d T_lidar_camera, const Directions& along,
                            int iterations) {
  double damping = 1e-3;
  const double sigma = agreement.sigma(T_lidar_camera);
  Sums here = agreement.sums(T_lidar_camera, sigma, true);
  for (int i = 0; i < iterations && damping < 1e6; ++i) {
    throw_if_stopped();
    const Eigen::Isometry3d T_next = moved(T_lidar_camera, step_along(along, here, damping));
    const Sums next = agreement.sums(T_next, sigma, true);
    if (next.n_points > 0.0 && next.cost / next.n_points < here.cost / here.n_points) {
      const double gained = 1.0 - next.cost / next.n_points / (here.cost / here.n_points);
      T_lidar_camera = T_next;
      here = next;
      damping *= 0.3;
      if (gained < 1e-9) break;
    } else {
      damping = damping < 1e-2 ? 1e-2 : damping * 10.0;
    }
  }
  return T_lidar_camera;
}

std::vector<KeptImage> read_images(const PosedImages& images, const RefineOptions& refine, int levels) {
  const std::vector<std::size_t> chosen = chosen_images(images, refine);
  std::vector<KeptImage> kept(chosen.size());
  report_progress("images", 0.2);
  parallel_chunks(kept.size(), 1, [&](std::size_t i, std::size_t) {
    kept[i] = {chosen[i], GrayPyramid(images.read(chosen[i]), levels), 1.0f};
  });
  return kept;
}

/// From coarse images to fine ones; each level sees what is visible with the calibration that it begins with.
class Refinement {
 public:
  Refinement(const PointCloud& map, const PosedImages& images, const ColorizeOptions& options,
             const RefineOptions& refine)
      : images_(images), options_(options), refine_(refine) {
    const double surfel_m = options.surfel_m ? *options.surfel_m : spacing_of(map);
    report_progress("surfaces", 0.1);
    surfels_ = surfels_of(map, {options.neighbors, surfel_m, 5.0 * surfel_m});
    kept_ = read_images(images, refine, levels_for(images.camera));
  }

  Eigen::Isometry3d from_start(const Directions& along) {
    Eigen::Isometry3d T_lidar_camera = images_.T_lidar_camera;
    for (int level = kept_.front().gray.levels() - 1; level >= 0; --level) {
      report_progress("extrinsic", 0.9 - 0.15 * level);
      make_tracks_at(level, T_lidar_camera);
      T_lidar_camera =
          minimized(Agreement(images_.camera, kept_, tracks_, level), T_lidar_camera, along, refine_.iterations);
    }
    return T_lidar_camera;
  }

  /// Of the last level, the finest.
  Agreement finest() const { return {images_.camera, kept_, tracks_, 0}; }
  const ViewTracks& tracks() const { return tracks_; }
  std::size_t n_images() const { return kept_.size(); }

 private:
  /// So many that what the start may be off is about two pixels of the coarsest.
  int levels_for(const CameraModel& camera) const {
    const double off_px = std::max(camera.fx, camera.fy) * refine_.largest_start_error_deg / kDegrees;
    return std::clamp(static_cast<int>(std::floor(std::log2(std::max(1.0, off_px)))) + 1, 1, 8);
  }

  /// In coarse images what lies behind an edge reaches farther over it.
  void make_tracks_at(int level, const Eigen::Isometry3d& T_lidar_camera) {
    ColorizeOptions options = options_;
    options.occlusion.edge_px *= 1 << level;
    tracks_ = make_tracks(surfels_, images_, kept_, T_lidar_camera, options, refine_);
    if (tracks_.n_points() >= kFewestPoints) return;
    throw UnsupportedError(
        fmt::format("the extrinsic cannot be refined: {} points are seen by at least {} of {} "
                    "images; {} are needed",
                    tracks_.n_points(), refine_.least_views, kept_.size(), kFewestPoints));
  }

  const PosedImages& images_;
  const ColorizeOptions& options_;
  const RefineOptions& refine_;
  Surfels surfels_;
  std::vector<KeptImage> kept_;
  ViewTracks tracks_;
};

/// The change, how sure it is, and what it improves.
void describe(const Refinement& refinement, const Eigen::Isometry3d& T_start, const Directions& along,
              double alignment_px, RefinedExtrinsic& result) {
  const Agreement finest = refinement.finest();
  const double sigma = finest.sigma(result.T_lidar_camera);
  const Sums before = finest.sums(T_start, sigma, false), after = finest.sums(result.T_lidar_camera, sigma, true);
  result.inconsistency_before = before.distance / before.n_points / 255.0;
  result.inconsistency_after = after.distance / after.n_points / 255.0;
  const Vector6d sigmas = covariance_of(after, along, alignment_px).diagonal().cwiseSqrt();
  result.turn_sigma_deg = kDegrees * sigmas.head<3>();
  result.shift_sigma_m = sigmas.tail<3>();
  result.improved = result.inconsistency_after < result.inconsistency_before;
  if (!result.improved) result.T_lidar_camera = T_start;
  const Eigen::Isometry3d change = T_start.inverse() * result.T_lidar_camera;
  result.turn_deg = kDegrees * rotation_log(Eigen::Quaterniond(change.linear()));
  result.shift_m = change.translation();
  result.n_images = refinement.n_images();
  result.n_points = refinement.tracks().n_points();
  result.n_views = refinement.tracks().views.size();
}

}  // namespace

RefinedExtrinsic refine_extrinsic(const PointCloud& map, const PosedImages& images, const ColorizeOptions& options,
                                  const RefineOptions& refine) {
  check(images.camera);
  Refinement refinement(map, images, options, refine);
  RefinedExtrinsic result;
  Directions along = Directions::Identity(6, 6);
  result.T_lidar_camera = refinement.from_start(along);
  const Agreement finest = refinement.finest();
  const Sums sums = finest.sums(result.T_lidar_camera, finest.sigma(result.T_lidar_camera), true);
  const Matrix6d covariance = covariance_of(sums, along, refine.alignment_px);
  along = told_directions(covariance, refine, result.free_axes);
  if (along.cols() == 0) {
    throw UnsupportedError("the extrinsic cannot be refined: these images tell no direction of it");
  }
  if (along.cols() < 6) result.T_lidar_camera = refinement.from_start(along);
  describe(refinement, images.T_lidar_camera, along, refine.alignment_px, result);
  return result;
}

}  // namespace cmap
