#pragma once

#include <cstdint>
#include <filesystem>

#include "cmap/core/array.hpp"
#include "cmap/geometry/session_predictions.hpp"
#include "cmap/io/faults.hpp"

namespace cmap {

/// Reads a session in either form of FORMATS: a folder with meta.json, frames.csv and the arrays, or VGGT's own
/// NAME.npz with NAME.frames.csv beside it, or frames.csv where no other NPZ file is (a folder may hold these two as
/// well).
///
/// Rotations are projected to SO(3), and everything is moved so that frame 0's camera is the session frame (a warning
/// where it was not nearly so). Pixels whose depth or confidence is zero or not finite get depth and confidence 0, with
/// a warning that counts them; so do points. Picture values a little outside [0,1] are clamped, with a warning that
/// counts them. Confidences below 1 and skipped members are warnings.
/// Throws InputError naming file, member and reason: anything missing or malformed, shapes or numbers of frames that
/// differ, a rotation beyond 1e-3, intrinsics of a picture of another size, a negative depth, a session without a
/// single valid pixel, times not increasing, a convention other than FORMATS'. With a list of faults it goes on after
/// each of these; what it returns is then whole only where none was added. Thread-safe.
SessionPredictions read_session_predictions(const std::filesystem::path& folder_or_npz, const Faults& faults = {});

/// Writes the folder form, whole or not at all; the folder must not exist. Depth as float32, poses as float64; times
/// are recorded without `time_offset_s`. Throws OutputError if it cannot be written, UsageError if a name
/// cannot stand in frames.csv, std::invalid_argument if sizes differ.
void write_session_predictions(const SessionPredictions& session, const std::filesystem::path& folder,
                               double time_offset_s = 0.0);

/// A keyframe of VGGT-SLAM: a point per pixel in a frame and unit common to all keyframes.
struct PointMap {
  double time_s = 0.0;        ///< the file's name
  int width = 0, height = 0;  ///< height 1 where the file does not keep the picture's shape
  Array<Eigen::Vector3f> points;
  Array<std::uint8_t> mask;  ///< 1: valid, and then finite
};

/// Reads `<stamp>.npz` with pointcloud (H,W,3) or (N,3) and mask (H,W) or (N,). Throws InputError naming file, member
/// and reason.
PointMap read_point_map(const std::filesystem::path& npz);

}  // namespace cmap
