#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cmap/recon/reconstruction.hpp"

namespace cmap {

/// sessions.json: {"sessions": [{index, name, frames, scale_prefusion, scale_registration, scale, linearity, ...}]}.
nlohmann::ordered_json sessions_json(const Reconstruction& reconstruction);

/// report.json: the sessions with the options, the pose graph, the map's size, warnings and the seconds of each stage.
nlohmann::ordered_json reconstruction_json(const Reconstruction& reconstruction, const ReconstructionOptions& options,
                                           const std::string& command);

/// A line for each session, then what the run made.
std::string reconstruction_table(const Reconstruction& reconstruction);

}  // namespace cmap
