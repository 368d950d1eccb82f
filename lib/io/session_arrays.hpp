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

/// The images of a session as VGGT or FORMATS stores them, (S,H,W,3) or (S,3,H,W), bytes or floats in [0,1].
Array<Rgb8> to_colors(const NpyArray& images, std::uint64_t frames, std::uint64_t height, std::uint64_t width);

}  // namespace cmap
