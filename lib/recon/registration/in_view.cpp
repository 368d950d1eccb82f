#include "registration/in_view.hpp"

#include <algorithm>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

/// Pre-fusion places cameras to some pixels and percent alone.
constexpr double kMargin = 0.1;

/// A frame's camera, ready to ask.
struct Frustum {
  Eigen::Matrix3d rotation;  ///< camera from world, with the session's scale in it
  Eigen::Vector3d translation;
  Eigen::Matrix3d K;

  bool holds(const Eigen::Vector3d& world, double width, double height, double farthest) const {
    const Eigen::Vector3d p = rotation * world + translation;
    if (p.z() <= 0.0 || p.z() > farthest) return false;
    const double u = K(0, 0) * p.x() / p.z() + K(0, 2), v = K(1, 1) * p.y() / p.z() + K(1, 2);
    return u > -kMargin * width && u < (1.0 + kMargin) * width && v > -kMargin * height && v < (1.0 + kMargin) * height;
  }
};

std::vector<Frustum> frusta_of(const SessionPredictions& session, const Similarity& T_world_session) {
  const Similarity T_session_world = T_world_session.inverse();
  std::vector<Frustum> frusta;
  for (std::size_t f = 0; f < session.frame_count(); ++f) {
    const Eigen::Isometry3d& T = session.T_camera_session[f];
    frusta.push_back({T.linear() * T_session_world.linear(), T.linear() * T_session_world.translation + T.translation(),
                      session.intrinsics[f]});
  }
  return frusta;
}

}  // namespace

PointCloud in_view(const PointCloud& cloud, const SessionPredictions& session, const Similarity& T_world_session) {
  const std::vector<Frustum> frusta = frusta_of(session, T_world_session);
  const double farthest =
      session.depth.empty() ? 0.0 : (1.0 + kMargin) * static_cast<double>(*std::ranges::max_element(session.depth));
  Array<std::uint8_t> keep(cloud.size());
  parallel_chunks(cloud.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d world = cloud.world(i);
      keep[i] = std::ranges::any_of(frusta, [&](const Frustum& frustum) {
        return frustum.holds(world, session.width, session.height, farthest);
      });
    }
  });
  return select(cloud, keep);
}

}  // namespace cmap
