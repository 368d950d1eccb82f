#include "cmap/recon/session_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

const Array<float>& confidence_of(const SessionPredictions& session, PointSource source) {
  if (source == PointSource::kDepth) return session.depth_confidence;
  if (session.world_points.empty())
    throw UsageError("points of the head are asked for; the session has no world_points");
  return session.world_points_confidence;
}

/// A pixel's point in the camera's frame.
Eigen::Vector3f point_of(const SessionPredictions& session, std::size_t frame, std::size_t pixel, PointSource source) {
  const std::size_t at = frame * session.pixels_per_frame() + pixel;
  if (source == PointSource::kHead) {
    return (session.T_camera_session[frame] * session.world_points[at].cast<double>()).cast<float>();
  }
  const Eigen::Matrix3d& K = session.intrinsics[frame];
  const auto width = static_cast<std::size_t>(session.width);
  const double d = session.depth[at], v = static_cast<double>(pixel / width), u = static_cast<double>(pixel % width);
  const double y = (v - K(1, 2)) / K(1, 1);
  const double x = (u - K(0, 2) - K(0, 1) * y) / K(0, 0);
  return Eigen::Vector3d(x * d, y * d, d).cast<float>();
}

/// Means of one frame's points, by voxel.
struct Mean {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double confidence = 0.0;
  std::uint32_t n = 0;
};

}  // namespace

double confidence_threshold(const SessionPredictions& session, const ConfidenceCut& cut, PointSource source) {
  std::vector<float> enough;
  for (const float c : confidence_of(session, source)) {
    if (c > 0.0f && c >= cut.floor) enough.push_back(c);
  }
  const auto n_dropped = static_cast<std::size_t>(cut.lowest_share * static_cast<double>(enough.size()));
  if (n_dropped < enough.size()) {
    std::ranges::nth_element(enough, enough.begin() + static_cast<std::ptrdiff_t>(n_dropped));
    return enough[n_dropped];
  }
  throw UnsupportedError(fmt::format("no pixel has a confidence of {:g} or more", cut.floor));
}

FramePoints frame_points(const SessionPredictions& session, std::size_t frame, double min_confidence,
                         PointSource source, double max_range) {
  const Array<float>& confidence = confidence_of(session, source);
  const std::size_t first = frame * session.pixels_per_frame();
  FramePoints points;
  for (std::size_t pixel = 0; pixel < session.pixels_per_frame(); ++pixel) {
    const float c = confidence[first + pixel];
    if (!(c > 0.0f) || c < min_confidence) continue;
    const Eigen::Vector3f point = point_of(session, frame, pixel, source);
    if (point.cast<double>().norm() > max_range) continue;
    points.positions.push_back(point);
    points.colors.push_back(session.images[first + pixel]);
    points.confidence.push_back(c);
    points.pixel.push_back(static_cast<std::uint32_t>(pixel));
  }
  return points;
}

SessionCloud session_cloud(const SessionPredictions& session, const Similarity& T_world_session, double min_confidence,
                           PointSource source, double voxel_m) {
  const std::size_t n = session.frame_count();
  const Eigen::Vector3d origin = choose_origin({T_world_session.translation, T_world_session.translation});
  std::vector<VoxelMap<Mean>> means(n);
  parallel_chunks(n, 1, [&](std::size_t frame, std::size_t) {
    const FramePoints points = frame_points(session, frame, min_confidence, source);
    const Eigen::Isometry3d T_session_camera = session.T_camera_session[frame].inverse();
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
      const Eigen::Vector3d p = T_world_session * (T_session_camera * points.positions[i].cast<double>()) - origin;
      const Eigen::Vector3d cell = (p / voxel_m).array().floor();
      if (!(cell.cwiseAbs().maxCoeff() < 1e9)) continue;
      const Eigen::Vector3i key = cell.cast<int>();
      Mean& mean = means[frame][{key.x(), key.y(), key.z()}];
      mean.sum += p;
      mean.confidence += points.confidence[i];
      ++mean.n;
    }
  });
  SessionCloud found;
  found.cloud.origin = origin;
  for (const VoxelMap<Mean>& of_frame : means) {
    for (const auto& [key, mean] : of_frame.entries()) {
      found.cloud.positions.push_back((mean.sum / mean.n).cast<float>());
      found.confidence.push_back(static_cast<float>(mean.confidence / mean.n));
    }
  }
  return found;
}

}  // namespace cmap
