#pragma once

#include "cmap/recon/camera_poses.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// Poses that contradict odometry's and agree with it when they are read in another convention are refused: the session
/// is of no use. All by the motion between pairs of frames.
struct PoseConventionOptions {
  double min_length_m = 0.2;     ///< of a motion (root mean square) whose direction tells
  double min_turn_deg = 5.0;     ///< of a turn (mean) that tells
  double contrary_cosine = 0.5;  ///< directions with less contradict
  double contrary_turn = 0.8;    ///< turns that are off by this share of their size contradict
  double same_cosine = 0.9;      ///< directions with more agree
  double same_turn = 0.3;        ///< turns that are off by less than this share of their size
  double same_turn_deg = 2.0;    ///< and this agree
};

/// How sessions are read, whatever the stage: which pixels are points, which frames are one picture, which pose of
/// odometry goes with a frame.
struct SessionInputOptions {
  PointSource points = PointSource::kDepth;
  ConfidenceCut confidence;
  double farthest_median_depths = 1000.0;  ///< pixels farther away count as not seen; a camera there is refused
  double same_frame_s = 1e-4;              ///< frames of two sessions at times no farther apart are one picture
  PosePairing pairing = PosePairing::kInterpolated;
  double max_gap_s = 0.15;  ///< between poses of odometry around a frame, or a LiDAR point
  PoseConventionOptions convention;
};

}  // namespace cmap
