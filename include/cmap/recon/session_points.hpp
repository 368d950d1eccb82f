#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/session_predictions.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// Which of a session's pixels are points. First the floor: sky has confidence 1, and must not use up the share.
struct ConfidenceCut {
  double floor = 1.5;         ///< pixels below this are dropped,
  double lowest_share = 0.2;  ///< and this share of the others, the lowest
};

enum class PointSource {
  kDepth,  ///< depth, intrinsics and poses
  kHead,   ///< VGGT's own points (world_points)
};

/// The confidence from which on pixels count. Throws UsageError where the head's points are asked for and the session
/// has none, UnsupportedError where nothing is left.
double confidence_threshold(const SessionPredictions& session, const ConfidenceCut& cut, PointSource source);

/// Points of one frame, in its camera's frame and the session's unit, in order of the pixels.
struct FramePoints {
  Array<Eigen::Vector3f> positions;
  Array<Rgb8> colors;
  Array<float> confidence;
  Array<std::uint32_t> pixel;  ///< row * width + column
};

/// The pixels of a frame with at least this confidence, and not farther from the camera than max_range (session units).
/// X = (u - cx) d / fx, Y = (v - cy) d / fy, Z = d, pixel centers at integers. Thread-safe.
FramePoints frame_points(const SessionPredictions& session, std::size_t frame, double min_confidence,
                         PointSource source, double max_range = std::numeric_limits<double>::infinity());

/// Points of a whole session and how sure it is of each, relative to each other.
struct SessionCloud {
  PointCloud cloud;  ///< no color
  Array<float> confidence;
};

/// All frames of a session in the world, placed as T_world_session says, each thinned to a mean point for every voxel.
/// @param voxel_m  of the world's meters.
SessionCloud session_cloud(const SessionPredictions& session, const Similarity& T_world_session, double min_confidence,
                           PointSource source, double voxel_m);

}  // namespace cmap
