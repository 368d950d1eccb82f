#pragma once

#include "clouds/array_store.hpp"
#include "cmap/geometry/session_predictions.hpp"

namespace cmap {

/// The arrays of a session, checked and brought into SessionPredictions; S, H and W are those of the depth, which comes
/// first. `frames` is not touched: it is the caller's to compare.
void read_depth(const ArrayStore& store, SessionPredictions& session, std::size_t& frame_count);
void read_images(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);
void read_intrinsics(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);
/// (S,3,4), or (S,4,4) with the last row 0 0 0 1.
void read_poses(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);
/// Does nothing where there are none.
void read_world_points(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);

/// VGGT's frame 0 is the session frame only nearly; from here on it is. Depth, poses and points must have been read.
void make_first_camera_the_frame(const ArrayStore& store, SessionPredictions& session);

}  // namespace cmap
