#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/session_predictions.hpp"
#include "cmap/sim/camera_view.hpp"

namespace cmap {

/// Predictions with the errors that VGGT makes. Defaults: depth 1 to 3 % off and poses of 10 cm and half a degree at
/// the end of a session, as measured on real sequences. All noise, bias, drift and fractions at 0: exact.
struct PredictionOptions {
  int session_length = 30;   ///< frames per call
  int session_overlap = 10;  ///< frames that two neighboring sessions share
  int image_stride = 1;      ///< every n-th image becomes a frame
  int width_px = 518;        ///< the network's input, a multiple of 14

  double unit_m = 10.0;      ///< a session's unit of length, drawn log-uniformly
  double unit_factor = 2.0;  ///< from unit_m / factor to unit_m * factor; 1: all the same

  double depth_noise_fraction = 0.005;  ///< standard deviation of a pixel's own relative error
  double depth_bias_fraction = 0.015;   ///< the same of the smooth error of whole regions, from depth_bias_range_m on;
  double depth_bias_range_m = 15.0;     ///< nearer it is proportional to depth
  double depth_bias_size_px = 150.0;    ///< shortest wavelength of that error
  double edge_fraction = 0.1;           ///< a depth edge: depths of neighboring pixels differ by more than this
  double floater_fraction = 0.5;        ///< share of the pixels at depth edges that float between near and far
  double max_depth_m = 100.0;           ///< farther surfaces are predicted like the sky
  double sky_depth_m = 150.0;           ///< where the sky is put, with confidence 1

  double pose_noise_m = 0.02;  ///< standard deviation per axis of each frame's own error
  double pose_noise_deg = 0.1;
  double pose_scale_fraction = 0.005;  ///< standard deviation of a session's error of the scale of its steps
  double pose_drift_fraction = 0.02;   ///< standard deviation per axis of each step's error, in steps
  double pose_drift_deg_per_frame = 0.08;
  double focal_noise_fraction = 0.003;  ///< of each frame's focal lengths, one factor for both

  std::vector<int> outlier_sessions;  ///< whose poses do not fit their depth
  double outlier_fraction = 0.0;      ///< of further such sessions, drawn
  double outlier_stretch = 1.6;       ///< factor on their translations

  double confidence_peak = 20.0;          ///< of an error of 0
  double confidence_half_error_m = 0.15;  ///< at which confidence falls to half of that (above 1)
  double confidence_insight = 0.5;  ///< share, of logarithms, of the true error in what the network believes its error
                                    ///< to be; the rest is the error to be expected there
  double confidence_noise = 0.3;    ///< standard deviation of the logarithm of that belief
  bool world_points = false;        ///< also points of a head of its own: other errors of the same size
};

/// Frames [first, first + count) of a session.
struct SessionRange {
  std::size_t first, count;
};

/// Consecutive sessions of `length` frames that share `overlap`; the last one may be shorter, but has more than
/// `overlap` frames, unless it is the only one. Throws UsageError unless 0 <= overlap < length.
std::vector<SessionRange> cut_sessions(std::size_t frames, int length, int overlap);

/// A frame as the network gets it, and the truth.
struct NetworkFrame {
  PredictionFrame frame;  ///< `index` is overwritten
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  CameraView view;  ///< network_image(), and the depth of what it shows
};

struct SimulatedSession {
  SessionPredictions predictions;
  double unit_m = 1.0;        ///< meters of depth per unit of the session: what truth/scales.json holds
  double pose_stretch = 1.0;  ///< other than 1: an outlier
};

/// What a network like VGGT makes of the frames of session number `session`. Errors, after draws of the seed, the
/// session and the frame, so that frames shared by sessions get different ones:
///  - depth: log d' = log d + noise + bias(u, v) min(1, d / bias range), bias a sum of waves that pass slowly through
///    the frames; at depth edges some pixels lie anywhere between near and far (in log depth); divided by the unit;
///  - confidence: 1 + (peak - 1) / (1 + belief / half_error), belief = error^insight expected^(1 - insight) e^noise;
///  - poses: steps from frame to frame with errors of scale, translation and rotation, then each frame's own error; an
///    outlier's are stretched; divided by the unit; the first frame is the identity.
/// Throws UsageError naming an option out of range, std::invalid_argument without frames or where their sizes differ.
SimulatedSession simulate_session(std::span<const NetworkFrame* const> frames, const CameraModel& network_camera,
                                  std::size_t session, const PredictionOptions& options, std::uint64_t seed);

}  // namespace cmap
