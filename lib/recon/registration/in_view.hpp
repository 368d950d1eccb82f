#pragma once

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/session_predictions.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// The points of a cloud, world frame, that lie in the frustum of some frame of a session: before the camera, within
/// its picture and a tenth of its size around it, no farther than a tenth more than the session's farthest depth. What
/// hides behind something else counts as well: the LiDAR stands elsewhere.
PointCloud in_view(const PointCloud& cloud, const SessionPredictions& session, const Similarity& T_world_session);

}  // namespace cmap
