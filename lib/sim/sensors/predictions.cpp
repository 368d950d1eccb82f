#include "cmap/sim/predictions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "capture/option_descriptions.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/sim/random_stream.hpp"
#include "sensors/depth_errors.hpp"
#include "sensors/pose_errors.hpp"

namespace cmap {
namespace {

void check_frames(std::span<const NetworkFrame* const> frames, const CameraModel& camera) {
  if (frames.empty()) throw std::invalid_argument("a session without frames");
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  for (const NetworkFrame* frame : frames) {
    if (frame->view.depth_m.size() != pixels || frame->view.image.pixels.size() != pixels) {
      throw std::invalid_argument("a frame that is not of the network's size");
    }
  }
}

double drawn_unit_m(std::size_t session, const PredictionOptions& o, std::uint64_t seed) {
  const double place = RandomStream(seed, kRandomSessionUnit, session).uniform(-1.0, 1.0);
  return o.unit_m * std::pow(o.unit_factor, place);
}

double drawn_stretch(std::size_t session, const PredictionOptions& o, std::uint64_t seed) {
  const bool listed = std::ranges::count(o.outlier_sessions, static_cast<int>(session)) > 0;
  const bool drawn = RandomStream(seed, kRandomSessionOutlier, session).uniform() < o.outlier_fraction;
  return listed || drawn ? o.outlier_stretch : 1.0;
}

void add_poses(SimulatedSession& session, std::span<const NetworkFrame* const> frames, std::size_t number,
               const PredictionOptions& o, std::uint64_t seed) {
  std::vector<Eigen::Isometry3d> truth;
  for (const NetworkFrame* frame : frames) truth.push_back(frame->T_world_camera);
  for (Eigen::Isometry3d T : with_pose_errors(truth, number, session.pose_stretch, o, seed)) {
    T.translation() /= session.unit_m;
    session.predictions.T_camera_session.push_back(T.inverse());
  }
}

void add_intrinsics(SessionPredictions& predictions, const CameraModel& camera, std::size_t number,
                    const PredictionOptions& o, std::uint64_t seed) {
  RandomStream random(seed, kRandomSessionIntrinsics, number);
  for (std::size_t i = 0; i < predictions.frame_count(); ++i) {
    const double factor = std::exp(o.focal_noise_fraction * random.normal());
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    K(0, 0) = factor * camera.fx;
    K(1, 1) = factor * camera.fy;
    K(0, 2) = camera.cx;
    K(1, 2) = camera.cy;
    predictions.intrinsics.push_back(K);
  }
}

/// Divided by the unit, behind what is there already.
void append_depth(SessionPredictions& predictions, const PredictedDepth& predicted, double unit_m) {
  for (const float d : predicted.depth_m) {
    predictions.depth.push_back(static_cast<float>(static_cast<double>(d) / unit_m));
  }
  predictions.depth_confidence.insert(predictions.depth_confidence.end(), predicted.confidence.begin(),
                                      predicted.confidence.end());
}

/// Points of frame i in the session's frame and unit, from a depth of their own.
void append_points(SessionPredictions& predictions, const PredictedDepth& predicted, std::size_t i, double unit_m) {
  const Eigen::Isometry3d T_session_camera = predictions.T_camera_session[i].inverse();
  const Eigen::Matrix3d& K = predictions.intrinsics[i];
  const auto width = static_cast<std::size_t>(predictions.width);
  for (std::size_t pixel = 0; pixel < predicted.depth_m.size(); ++pixel) {
    const double depth = static_cast<double>(predicted.depth_m[pixel]) / unit_m;
    const double u = static_cast<double>(pixel % width), v = static_cast<double>(pixel / width);
    const Eigen::Vector3d p((u - K(0, 2)) / K(0, 0) * depth, (v - K(1, 2)) / K(1, 1) * depth, depth);
    predictions.world_points.push_back((T_session_camera * p).cast<float>());
  }
  predictions.world_points_confidence.insert(predictions.world_points_confidence.end(), predicted.confidence.begin(),
                                             predicted.confidence.end());
}

void check_prediction_options(const PredictionOptions& options) {
  check_fields(options, "predictions");
  if (options.sky_depth_m < options.max_depth_m) {
    throw UsageError("predictions: sky_depth_m must be at least max_depth_m");
  }
}

}  // namespace

SimulatedSession simulate_session(std::span<const NetworkFrame* const> frames, const CameraModel& camera,
                                  std::size_t number, const PredictionOptions& o, std::uint64_t seed) {
  check_prediction_options(o);
  check_frames(frames, camera);
  SimulatedSession session;
  session.unit_m = drawn_unit_m(number, o, seed);
  session.pose_stretch = drawn_stretch(number, o, seed);
  SessionPredictions& predictions = session.predictions;
  predictions.width = camera.width;
  predictions.height = camera.height;
  for (const NetworkFrame* frame : frames) {
    predictions.frames.push_back(frame->frame);
    predictions.frames.back().index = predictions.frames.size() - 1;
    const Array<Rgb8>& pixels = frame->view.image.pixels;
    predictions.images.insert(predictions.images.end(), pixels.begin(), pixels.end());
  }
  add_poses(session, frames, number, o, seed);
  add_intrinsics(predictions, camera, number, o, seed);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto with_errors = [&](std::uint64_t field_purpose, std::uint64_t pixel_purpose) {
      return with_depth_errors(frames[i]->view.depth_m, camera.width, camera.height, o,
                               {seed, field_purpose, pixel_purpose, number, i});
    };
    append_depth(predictions, with_errors(kRandomDepthField, kRandomDepthPixel), session.unit_m);
    if (o.world_points)
      append_points(predictions, with_errors(kRandomPointField, kRandomPointPixel), i, session.unit_m);
  }
  return session;
}

}  // namespace cmap
