#pragma once

#include "cmap/io/capture.hpp"
#include "cmap/io/session_file.hpp"

namespace cmap {

/// Takes from a session what no scene has: see below. `name` is for messages.
void make_usable(const std::string& name, SessionPredictions& session);

/// A session of a capture (read_session()) without what no scene has: a pixel beyond 1000 median depths counts as not
/// seen, with a warning; a camera that far from the first throws InputError. One such number would else decide the size
/// of the map.
SessionPredictions read_usable_predictions(const Capture& capture, std::size_t session);

}  // namespace cmap
