#pragma once

#include "cmap/core/enum_names.hpp"

namespace cmap {

struct RegistrationMethod;

/// What moves a map onto another.
enum class AlignKind {
  kNone,
  kRegistration,  ///< of the maps' points, as in align.hpp
  kTrajectory,    ///< the poses of two trajectories: align_trajectories()
  kTanksAndTemples,
};

struct AlignMethod {
  AlignKind kind = AlignKind::kNone;
  const RegistrationMethod* registration = nullptr;  ///< of kRegistration

  bool operator==(const AlignMethod&) const = default;
};

/// "none", the names of registration_methods(), "trajectory", "tanksandtemples".
const EnumNames<AlignMethod>& align_method_names();

/// Whether it starts from an initial transform.
bool needs_initial(const AlignMethod& method);

}  // namespace cmap
