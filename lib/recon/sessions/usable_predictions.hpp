#pragma once

#include "cmap/geometry/session_predictions.hpp"
#include "cmap/io/capture.hpp"

namespace cmap {

/// Takes from a session what no scene has: see below. `name` is for messages.
void make_usable(const std::string& name, double farthest_median_depths, SessionPredictions& session);

/// A session of a capture (read_session()) without what no scene has: a pixel beyond this many median depths counts as
/// not seen, with a warning; a camera that far from the first throws InputError. One such number would else decide the
/// size of the map.
SessionPredictions read_usable_predictions(const Capture& capture, std::size_t session, double farthest_median_depths);

}  // namespace cmap
