#pragma once

#include <filesystem>

#include "cmap/io/session_predictions.hpp"

namespace cmap {

/// A session's predictions without what no scene has: a pixel beyond 1000 median depths counts as not seen, with a
/// warning; a camera that far from the first throws InputError. One such number would else decide the size of the map.
SessionPredictions read_usable_predictions(const std::filesystem::path& folder_or_npz);

}  // namespace cmap
