#pragma once

#include <functional>
#include <vector>

#include "cmap/recon/registration.hpp"
#include "cmap/recon/session_input.hpp"
#include "sessions/session_state.hpp"

namespace cmap {

struct RegistrationIn {
  const Capture& capture;                     ///< sessions, scans and poses are read
  const std::vector<SessionState>& sessions;  ///< as pre-fusion has placed them
};

/// All sessions, those that are kept moved onto the LiDAR, and the links between these.
struct RegistrationOut {
  std::vector<SessionState> sessions;
  std::vector<SessionLink> links;  ///< by place in the list of those that are kept
};

template <class Fields>
void describe(Fields& f, StateOf<Fields, SessionLink>& l) {
  f.field("from", l.from);
  f.field("to", l.to);
  f.field("from_frame", l.from_frame);
  f.field("to_frame", l.to_frame);
  f.field("T_from_to", l.T_from_to);
  f.field("rmse_m", l.rmse_m);
  f.field("n_points", l.n_points);
  f.field("refined", l.refined);
}

template <class Fields>
void describe(Fields& f, StateOf<Fields, RegistrationOut>& out) {
  f.field("sessions", out.sessions);
  f.field("links", out.links);
}

/// The second stage: one session is in memory, and the one before it. `progress` gets the share that is done. Throws
/// InputError where a session or a scan cannot be read.
RegistrationOut run_registration(const RegistrationIn& in, const SessionInputOptions& input,
                                 const RegistrationOptions& options, const std::function<void(double)>& progress = {});

}  // namespace cmap
