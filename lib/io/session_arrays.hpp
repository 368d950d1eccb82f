#pragma once

#include "cmap/io/session_predictions.hpp"
#include "io/array_store.hpp"

namespace cmap {

/// The arrays of a session, checked and brought into SessionPredictions; S, H and W are those of the depth, which comes
/// first. `frames` is not touched: it is the caller's to compare.
void read_depth(const ArrayStore& store, SessionPredictions& session, std::size_t& frame_count);
void read_images(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);
void read_cameras(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);
/// Does nothing where there are none.
void read_world_points(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count);

}  // namespace cmap
