#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cmap/recon/pre_fusion.hpp"
#include "cmap/recon/session_input.hpp"
#include "sessions/session_state.hpp"

namespace cmap {

struct PreFusionIn {
  const Capture& capture;                   ///< sessions and poses are read
  std::optional<std::size_t> only_session;  ///< none: all
};

/// Every session that was read for, with what its poses and overlaps say of its scale, and placed; also those that are
/// dropped.
struct PreFusionOut {
  std::vector<SessionState> sessions;
};

template <class Fields>
void describe(Fields& f, StateOf<Fields, PreFusionOut>& out) {
  f.field("sessions", out.sessions);
}

/// The first stage. `progress` gets the share that is done. Throws as pre_fuse(); what is wrong with a session drops
/// it.
PreFusionOut run_pre_fusion(const PreFusionIn& in, const SessionInputOptions& input, const PreFusionOptions& options,
                            const std::function<void(double)>& progress = {});

}  // namespace cmap
