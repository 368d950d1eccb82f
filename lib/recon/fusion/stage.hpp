#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cmap/recon/map_fusion.hpp"
#include "cmap/recon/session_input.hpp"
#include "sessions/session_state.hpp"

namespace cmap {

struct FusionIn {
  const Capture& capture;                     ///< sessions are read
  const std::vector<SessionState>& sessions;  ///< those that are dropped are not looked at
  const std::vector<PlacedSession>& poses;    ///< of those that are kept, where the pose graph has put them
  /// Gets each session's own map as soon as it is there; empty: nobody wants them.
  std::function<void(const std::string& session, const PointCloud& map)> session_map;
};

struct FusionOut {
  PointCloud map;
  std::uint64_t points_fused = 0;
  std::vector<SessionSketch> sketches;  ///< of each session that is kept
};

/// The last stage: one session is in memory, and the map. `progress` gets the share that is done. Throws InputError
/// where a session cannot be read, UnsupportedError where no point is within max_range_m, UsageError for options.
FusionOut run_fusion(const FusionIn& in, const SessionInputOptions& input, const FusionOptions& options,
                     const std::function<void(double)>& progress = {});

}  // namespace cmap
