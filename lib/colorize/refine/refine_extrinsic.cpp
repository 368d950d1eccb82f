#include "cmap/colorize/refine_extrinsic.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/rotation.hpp"
#include "refine/view_tracks.hpp"

namespace cmap {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kTrackChunk = 256;
constexpr std::size_t kFewestPoints = 100;
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The camera moved in its own frame by a turn and a shift.
Eigen::Isometry3d moved(const Eigen::Isometry3d& T_lidar_camera, const Vector6d& change) {
  Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
  by.linear() = rotation_from(change.head<3>());
  by.translation() = change.tail<3>();
  return T_lidar_camera * by;
}

/// A gray level and how it changes with the camera's turn and shift.
struct Level {
  double level = 0.0, weight = 0.0;
  Vector6d slope = Vector6d::Zero();
  double sq_gradient = 0.0;
};

/// Sums over points: the normal equations and what goes with them.
struct Sums {
  double cost = 0.0, distance = 0.0, n_points = 0.0;
  double sq_gradients = 0.0;  ///< with the weights of the information
  Matrix6d information = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();

  Sums& operator+=(const Sums& o) {
    cost += o.cost;
    distance += o.distance;
    n_points += o.n_points;
    sq_gradients += o.sq_gradients;
    information += o.information;
    right += o.right;
    return *this;
  }
};

/// One level of the images, with the views that are compared.
class Agreement {
 public:
  Agreement(const CameraModel& camera, const std::vector<KeptImage>& kept, const ViewTracks& tracks, int level)
      : camera_(camera), kept_(kept), tracks_(tracks), level_(level) {}

  /// Robust standard deviation of the residuals.
  double sigma(const Eigen::Isometry3d& T_lidar_camera) const {
    std::vector<double> residuals;
    std::vector<Level> levels;
    for (std::size_t p = 0; p < tracks_.n_points(); ++p) {
      const double mean = levels_of(p, T_lidar_camera.inverse(), false, levels).level;
      for (const Level& l : levels) residuals.push_back(l.level - mean);
    }
    return residuals.empty() ? 1.0 : std::max(0.1, robust_sigma(residuals, 0.0));
  }

  Sums sums(const Eigen::Isometry3d& T_lidar_camera, double sigma, bool with_slopes) const {
    const Eigen::Isometry3d T_camera_lidar = T_lidar_camera.inverse();
    return ordered_sum<Sums>(tracks_.n_points(), kTrackChunk, [&](std::size_t begin, std::size_t end) {
      Sums part;
      std::vector<Level> levels;
      for (std::size_t p = begin; p < end; ++p) {
        const Level mean = levels_of(p, T_camera_lidar, with_slopes, levels);
        if (levels.size() < 2) continue;
        double distance = 0.0;
        for (const Level& l : levels) {
          const double r = (l.level - mean.level) / sigma, weight = l.weight / mean.weight;
          part.cost += weight * std::log1p(r * r);
          distance += weight * std::abs(l.level - mean.level);
          if (!with_slopes) continue;
          const Vector6d slope = (l.slope - mean.slope) / sigma;
          const double robust = weight / (1.0 + r * r);
          part.sq_gradients += robust * l.sq_gradient / (sigma * sigma);
          part.information += robust * slope * slope.transpose();
          part.right -= robust * r * slope;
        }
        part.distance += distance;
        part.n_points += 1.0;
      }
      return part;
    });
  }

 private:
  /// Of a point in the images that show it, and their weighted mean.
  Level levels_of(std::size_t point, const Eigen::Isometry3d& T_camera_lidar, bool with_slopes,
                  std::vector<Level>& levels) const {
    levels.clear();
    Level mean;
    for (const TrackView& view : tracks_.of(point)) {
      const Eigen::Vector3d p = T_camera_lidar * view.position_lidar;
      const auto pixel = project(camera_, p);
      if (!pixel) continue;
      const KeptImage& image = kept_[view.image];
      const auto sample = image.gray.at(level_, *pixel);
      if (!sample) continue;
      const Eigen::Vector2d gradient = sample->gradient.cast<double>() / image.gain;
      Level level{sample->level / image.gain, view.weight, Vector6d::Zero(), gradient.squaredNorm()};
      if (with_slopes) level.slope = slope(p, *pixel, gradient);
      mean.level += level.weight * level.level;
      mean.slope += level.weight * level.slope;
      mean.weight += level.weight;
      levels.push_back(level);
    }
    mean.level /= mean.weight;
    mean.slope /= mean.weight;
    return mean;
  }

  /// By the chain rule; of the projection by differences, as for any camera.
  Vector6d slope(const Eigen::Vector3d& p, const Eigen::Vector2d& pixel, const Eigen::Vector2d& gradient) const {
    const double step = 1e-5 * p.norm();
    Eigen::Vector3d by_point = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d other = p;
      other[axis] += step;
      const auto beside = project(camera_, other);
      if (beside) by_point[axis] = gradient.dot(*beside - pixel) / step;
    }
    // Where the camera turns by w and moves by t, the point moves by p x w - t.
    Vector6d slope;
    slope << by_point.cross(p), -by_point;
    return slope;
  }

  const CameraModel& camera_;
  const std::vector<KeptImage>& kept_;
  const ViewTracks& tracks_;
  int level_;
};

/// The directions in which the camera may be moved: columns.
using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The step that the normal equations ask for, along these directions.
Vector6d step_along(const Directions& along, const Matrix6d& information, const Vector6d& right, double damping) {
  Eigen::MatrixXd reduced = along.transpose() * information * along;
  reduced.diagonal() *= 1.0 + damping;
  return along * reduced.ldlt().solve(along.transpose() * right);
}

/// Levenberg-Marquardt.
Eigen::Isometry3d minimized(const Agreement& agreement, Eigen::Isometry3d T_lidar_camera, const Directions& along,
                            int iterations) {
  double damping = 1e-3;
  const double sigma = agreement.sigma(T_lidar_camera);
  Sums here = agreement.sums(T_lidar_camera, sigma, true);
  for (int i = 0; i < iterations && damping < 1e6; ++i) {
    throw_if_stopped();
    const Eigen::Isometry3d T_next = moved(T_lidar_camera, step_along(along, here.information, here.right, damping));
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

/// How well the calibration is known, as covariance. Noise averages out over so many views; what does not is that
/// views of unlike resolution and light are aligned to a part of a pixel, however many they are. The information holds
/// squared changes of gray, the sum of squared gradients turns them into pixels.
Matrix6d covariance_of(const Sums& sums, const Directions& along, double alignment_px) {
  const Eigen::MatrixXd reduced = along.transpose() * sums.information * along;
  const Eigen::MatrixXd inverse = reduced.ldlt().solve(Eigen::MatrixXd::Identity(along.cols(), along.cols()));
  return alignment_px * alignment_px * sums.sq_gradients * (along * inverse * along.transpose());
}

/// The directions that are known well enough, turns and shifts measured by what they may be off; names of the others'
/// main axes.
Directions told_directions(const Matrix6d& covariance, const RefineOptions& refine,
                           std::vector<std::string>& free_axes) {
  static constexpr const char* kNames[] = {"turn x", "turn y", "turn z", "shift x", "shift y", "shift z"};
  Vector6d unit;
  unit << Eigen::Vector3d::Constant(refine.largest_sigma_deg / kDegrees),
      Eigen::Vector3d::Constant(refine.largest_sigma_m);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(unit.cwiseInverse().asDiagonal() * covariance *
                                                     unit.cwiseInverse().asDiagonal());
  Directions told(6, 0);
  for (int i = 0; i < 6; ++i) {
    const Vector6d axis = axes.eigenvectors().col(i);
    if (axes.eigenvalues()[i] <= 1.0) {
      told.conservativeResize(6, told.cols() + 1);
      told.rightCols<1>() = unit.cwiseProduct(axis);
    } else {
      Eigen::Index most = 0;
      axis.cwiseAbs().maxCoeff(&most);
      free_axes.emplace_back(kNames[most]);
    }
  }
  return told;
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
