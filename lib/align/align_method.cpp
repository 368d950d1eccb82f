#include "cmap/align/align_method.hpp"

#include "cmap/align/align.hpp"

namespace cmap {

const EnumNames<AlignMethod>& align_method_names() {
  static const EnumNames<AlignMethod> names = [] {
    EnumNames<AlignMethod> all{{{}, "none"}};
    for (const RegistrationMethod* method : registration_methods()) {
      all.push_back({{AlignKind::kRegistration, method}, method->name});
    }
    all.push_back({{AlignKind::kTrajectory}, "trajectory"});
    all.push_back({{AlignKind::kTanksAndTemples}, "tanksandtemples"});
    return all;
  }();
  return names;
}

bool needs_initial(const AlignMethod& method) {
  if (method.kind == AlignKind::kRegistration) return method.registration->needs_initial;
  return method.kind == AlignKind::kTanksAndTemples;
}

}  // namespace cmap
