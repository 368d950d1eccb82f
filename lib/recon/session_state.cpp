#include "session_state.hpp"

#include <limits>

#include "cmap/io/transform_file.hpp"
#include "usable_predictions.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

template <class Matrix>
Json numbers(const Matrix& matrix) {
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

template <class Matrix>
Matrix matrix_from(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  Matrix matrix;
  if (values.size() != static_cast<std::size_t>(matrix.size())) throw std::invalid_argument("a matrix of another size");
  std::copy(values.begin(), values.end(), matrix.data());
  return matrix;
}

Json pose_json(const Eigen::Isometry3d& pose) { return numbers(pose.matrix()); }
Eigen::Isometry3d pose_from(const Json& json) { return Eigen::Isometry3d(matrix_from<Eigen::Matrix4d>(json)); }

/// JSON has no NaN and writes null.
double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

SessionOutcome outcome_from(const Json& json) {
  SessionOutcome o;
  o.index = json.at("index");
  o.name = json.at("name");
  o.frames = json.at("frames");
  o.scale_prefusion = json.at("scale_prefusion");
  o.scale_registration = json.at("scale_registration");
  o.linearity = json.at("linearity");
  o.rotation_corrected = json.at("rotation_corrected");
  o.scale_inlier = json.at("scale_inlier");
  o.prefusion_rmse_m = json.at("prefusion_rmse_m");
  o.overlap = number_or_nan(json.at("overlap"));
  o.rmse_m = number_or_nan(json.at("rmse_m"));
  o.flags = json.at("flags").get<std::vector<std::string>>();
  o.dropped = json.at("dropped").is_null() ? "" : json.at("dropped").get<std::string>();
  return o;
}

Json written(const SessionState& s) {
  Json poses = Json::array();
  for (const Eigen::Isometry3d& pose : s.placed.T_world_camera) poses.push_back(pose_json(pose));
  return {{"outcome", written(s.outcome)},
          {"scale", s.T_world_session.scale},
          {"rotation", numbers(s.T_world_session.rotation)},
          {"translation", numbers(s.T_world_session.translation)},
          {"min_confidence", s.min_confidence},
          {"center_factor", s.center_factor},
          {"placed",
           {{"scale", s.placed.scale}, {"time_s", s.placed.time_s}, {"poses", poses}, {"rmse_m", s.placed.rmse_m}}}};
}

SessionState state_from(const Json& json) {
  SessionState s;
  s.outcome = outcome_from(json.at("outcome"));
  s.T_world_session.scale = json.at("scale");
  s.T_world_session.rotation = matrix_from<Eigen::Matrix3d>(json.at("rotation"));
  s.T_world_session.translation = matrix_from<Eigen::Vector3d>(json.at("translation"));
  s.min_confidence = json.at("min_confidence");
  s.center_factor = json.at("center_factor");
  const Json& placed = json.at("placed");
  s.placed.index = s.outcome.index;
  s.placed.scale = placed.at("scale");
  s.placed.time_s = placed.at("time_s").get<std::vector<double>>();
  s.placed.rmse_m = placed.at("rmse_m");
  for (const Json& pose : placed.at("poses")) s.placed.T_world_camera.push_back(pose_from(pose));
  return s;
}

}  // namespace

Json written(const SessionOutcome& o) {
  return {{"index", o.index},
          {"name", o.name},
          {"frames", o.frames},
          {"scale_prefusion", o.scale_prefusion},
          {"scale_registration", o.scale_registration},
          {"scale", o.scale()},
          {"linearity", o.linearity},
          {"rotation_corrected", o.rotation_corrected},
          {"scale_inlier", o.scale_inlier},
          {"prefusion_rmse_m", o.prefusion_rmse_m},
          {"overlap", o.overlap},
          {"rmse_m", o.rmse_m},
          {"flags", o.flags},
          {"dropped", o.dropped.empty() ? Json(nullptr) : Json(o.dropped)}};
}

Json written(const std::vector<SessionState>& sessions, const std::vector<SessionLink>& links) {
  Json json{{"sessions", Json::array()}, {"links", Json::array()}};
  for (const SessionState& s : sessions) json["sessions"].push_back(written(s));
  for (const SessionLink& l : links) {
    json["links"].push_back({{"from", l.from},
                             {"to", l.to},
                             {"from_frame", l.from_frame},
                             {"to_frame", l.to_frame},
                             {"T_from_to", pose_json(l.T_from_to)},
                             {"rmse_m", l.rmse_m},
                             {"n_points", l.n_points},
                             {"refined", l.refined}});
  }
  return json;
}

void read_state(const Json& json, std::vector<SessionState>& sessions, std::vector<SessionLink>& links) {
  for (const Json& s : json.at("sessions")) sessions.push_back(state_from(s));
  for (const Json& l : json.at("links")) {
    links.push_back({l.at("from"), l.at("to"), l.at("from_frame"), l.at("to_frame"), pose_from(l.at("T_from_to")),
                     l.at("rmse_m"), l.at("n_points"), l.at("refined")});
  }
}

CameraMount mount_of(const Capture& capture) {
  return {capture.calibration.T_imu_lidar, capture.calibration.T_lidar_camera};
}

OdometryPoses odometry_poses(const Capture& capture, std::span<const double> times_s, const PreFusionOptions& options) {
  return camera_poses(capture.lio, mount_of(capture), times_s, options.pairing, options.max_gap_s);
}

SessionPredictions read_corrected(const Capture& capture, const SessionState& state) {
  SessionPredictions session = read_usable_predictions(capture, state.outcome.index);
  if (state.center_factor == 1.0) return session;
  for (std::size_t frame = 0; frame < session.frame_count(); ++frame) {
    Eigen::Isometry3d& T_camera_session = session.T_camera_session[frame];
    const Eigen::Isometry3d before = T_camera_session;
    T_camera_session.translation() *= state.center_factor;  // so is the center, -R^T t
    if (session.world_points.empty()) continue;
    const Eigen::Isometry3f shift = (T_camera_session.inverse() * before).cast<float>();
    const std::size_t first = frame * session.pixels_per_frame();
    for (std::size_t i = 0; i < session.pixels_per_frame(); ++i) {
      session.world_points[first + i] = shift * session.world_points[first + i];
    }
  }
  return session;
}

}  // namespace cmap
