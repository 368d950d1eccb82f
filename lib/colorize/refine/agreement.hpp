#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cmap/geometry/camera_model.hpp"
#include "refine/view_tracks.hpp"

namespace cmap {

/// A turn (rad) and a shift (m) of the camera in its own frame, in this order.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

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

/// How far one level of the images agrees about the points of the tracks. Refers to what it is made from. Thread-safe.
class Agreement {
 public:
  Agreement(const CameraModel& camera, const std::vector<KeptImage>& kept, const ViewTracks& tracks, int level)
      : camera_(camera), kept_(kept), tracks_(tracks), level_(level) {}

  /// Robust standard deviation of gray levels from their points' means.
  double sigma(const Eigen::Isometry3d& T_lidar_camera) const;

  /// With slopes also information, right side and gradients. The same for any number of threads.
  Sums sums(const Eigen::Isometry3d& T_lidar_camera, double sigma, bool with_slopes) const;

 private:
  struct Level;
  Level levels_of(std::size_t point, const Eigen::Isometry3d& T_camera_lidar, bool with_slopes,
                  std::vector<Level>& levels) const;
  Vector6d slope(const Eigen::Vector3d& p, const Eigen::Vector2d& pixel, const Eigen::Vector2d& gradient) const;

  const CameraModel& camera_;
  const std::vector<KeptImage>& kept_;
  const ViewTracks& tracks_;
  int level_;
};

}  // namespace cmap
