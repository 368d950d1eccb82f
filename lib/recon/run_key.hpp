#pragma once

#include <nlohmann/json.hpp>

#include "cmap/recon/reconstruction.hpp"

namespace cmap {

/// What a later run must share to go on from this one's stages: the version, the options, and the capture's files by
/// name, size and time of change.
nlohmann::ordered_json run_key(const Capture& capture, const ReconstructionOptions& options,
                               std::optional<std::size_t> only_session);

}  // namespace cmap
