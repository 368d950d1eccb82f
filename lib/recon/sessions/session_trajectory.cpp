#include "sessions/session_trajectory.hpp"

#include <algorithm>
#include <map>

namespace cmap {

Trajectory trajectory_of(const std::vector<PlacedSession>& sessions, const CaptureCalibration& calibration) {
  const Eigen::Isometry3d T_camera_imu = (calibration.T_imu_lidar * calibration.T_lidar_camera).inverse();
  struct Choice {
    std::size_t from_end = 0;
    Eigen::Isometry3d T_world_camera;
  };
  std::map<double, Choice> choices;
  for (const PlacedSession& session : sessions) {
    const std::size_t n = session.time_s.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t from_end = std::min(i, n - 1 - i);
      const auto [place, is_new] = choices.try_emplace(session.time_s[i], Choice{from_end, session.T_world_camera[i]});
      if (!is_new && from_end > place->second.from_end) place->second = {from_end, session.T_world_camera[i]};
    }
  }
  Trajectory trajectory;
  for (const auto& [time_s, choice] : choices) {
    const Eigen::Isometry3d T_world_imu = choice.T_world_camera * T_camera_imu;
    trajectory.push_back({time_s, T_world_imu.translation(), Eigen::Quaterniond(T_world_imu.linear())});
  }
  return trajectory;
}

}  // namespace cmap
