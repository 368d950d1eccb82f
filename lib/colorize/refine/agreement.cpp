#include "refine/agreement.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr std::size_t kTrackChunk = 256;

}  // namespace

/// A gray level and how it changes with the camera's turn and shift.
struct Agreement::Level {
  double level = 0.0, weight = 0.0;
  Vector6d slope = Vector6d::Zero();
  double sq_gradient = 0.0;
};

double Agreement::sigma(const Eigen::Isometry3d& T_lidar_camera) const {
  std::vector<double> residuals;
  std::vector<Level> levels;
  for (std::size_t p = 0; p < tracks_.n_points(); ++p) {
    const double mean = levels_of(p, T_lidar_camera.inverse(), false, levels).level;
    for (const Level& l : levels) residuals.push_back(l.level - mean);
  }
  return residuals.empty() ? 1.0 : std::max(0.1, robust_sigma(residuals, 0.0));
}

Sums Agreement::sums(const Eigen::Isometry3d& T_lidar_camera, double sigma, bool with_slopes) const {
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

/// Of a point in the images that show it, and their weighted mean.
Agreement::Level Agreement::levels_of(std::size_t point, const Eigen::Isometry3d& T_camera_lidar, bool with_slopes,
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
Vector6d Agreement::slope(const Eigen::Vector3d& p, const Eigen::Vector2d& pixel,
                          const Eigen::Vector2d& gradient) const {
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

}  // namespace cmap
