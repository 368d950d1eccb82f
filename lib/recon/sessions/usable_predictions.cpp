#include "sessions/usable_predictions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

double median_depth(const SessionPredictions& session) {
  std::vector<float> seen;
  std::ranges::copy_if(session.depth, std::back_inserter(seen), [](float depth) { return depth > 0.0f; });
  return median(seen);
}

void require_near_cameras(const std::string& name, const SessionPredictions& session, double typical_depth,
                          double farthest_median_depths) {
  for (std::size_t frame = 0; frame < session.frame_count(); ++frame) {
    const double distance = session.T_camera_session[frame].translation().norm();
    if (distance <= farthest_median_depths * typical_depth) continue;
    throw InputError(fmt::format("{}: frame {}: its camera is {:.3g} median depths away from the first", name, frame,
                                 distance / typical_depth));
  }
}

/// How many pixels are farther, none of them seen from now on.
std::size_t forget_far(double farthest, SessionPredictions& session) {
  std::size_t n_far = 0;
  for (std::size_t i = 0; i < session.depth.size(); ++i) {
    const bool is_far = session.depth[i] > farthest;
    if (is_far) session.depth[i] = session.depth_confidence[i] = 0.0f;
    bool is_far_point = false;
    if (!session.world_points.empty() && session.world_points_confidence[i] != 0.0f) {
      is_far_point = !(session.world_points[i].cast<double>().norm() <= 2.0 * farthest);  // cameras are away, too
      if (is_far_point) session.world_points_confidence[i] = 0.0f;
    }
    if (is_far || is_far_point) ++n_far;
  }
  return n_far;
}

}  // namespace

void make_usable(const std::string& name, double farthest_median_depths, SessionPredictions& session) {
  const double typical_depth = median_depth(session);
  require_near_cameras(name, session, typical_depth, farthest_median_depths);
  if (const std::size_t n_far = forget_far(farthest_median_depths * typical_depth, session); n_far > 0) {
    session.warnings.push_back(
        {"far_pixels", fmt::format("{}: {} of {} pixels are farther than {:g} median depths; they count as not seen",
                                   name, n_far, session.depth.size(), farthest_median_depths)});
  }
}

SessionPredictions read_usable_predictions(const Capture& capture, std::size_t index, double farthest_median_depths) {
  SessionPredictions session = read_session(capture, index);
  make_usable(capture.sessions[index].string(), farthest_median_depths, session);
  return session;
}

}  // namespace cmap
