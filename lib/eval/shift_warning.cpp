#include "cmap/eval/shift_warning.hpp"

#include <fmt/format.h>

#include <optional>

#include "cloud_body.hpp"
#include "cmap/io/shift_hint.hpp"

namespace cmap {
namespace {

/// A translation of the estimate, and what tells of it.
struct Candidate {
  Eigen::Vector3d translation_m;
  std::string where;
  bool is_approximate;
};

/// Each shift either way, as a comment may name what was taken off or what is to be added; and both maps' together.
std::vector<Candidate> candidates(const std::vector<ShiftHint>& reference, const std::vector<ShiftHint>& estimate) {
  std::vector<Candidate> all;
  for (const double sign : {1.0, -1.0}) {
    for (const ShiftHint& e : estimate) all.push_back({sign * e.shift_m, e.where, e.is_approximate});
    for (const ShiftHint& r : reference) all.push_back({-sign * r.shift_m, r.where, r.is_approximate});
    for (const ShiftHint& e : estimate) {
      for (const ShiftHint& r : reference) {
        all.push_back(
            {sign * (e.shift_m - r.shift_m), e.where + " with " + r.where, e.is_approximate || r.is_approximate});
      }
    }
  }
  return all;
}

std::string sentence(const Candidate& shift) {
  const Eigen::Vector3d t = shift.translation_m.array() + 0.0;  // -0 becomes 0
  return fmt::format(
      "{} names a shift that brings the maps together; it is not applied: give --transform a file that "
      "holds the 16 numbers 1 0 0 {} 0 1 0 {} 0 0 1 {} 0 0 0 1{}",
      shift.where, t.x(), t.y(), t.z(), shift.is_approximate ? " (about: --align is needed after it)" : "");
}

}  // namespace

void warn_about_shifts(EvaluatedPair& evaluation, const std::filesystem::path& reference,
                       const std::filesystem::path& estimate) {
  constexpr double kTogether = 0.01;  // of the gap may be left, as of heights above another surface
  const Box3d fixed = evaluation.pair.reference.index.bounds(), moving = evaluation.pair.estimate.index.bounds();
  double smallest_m = kTogether * gap_between(fixed, moving);
  if (smallest_m == 0.0 || evaluation.T_ref_est != Eigen::Matrix4d::Identity()) return;
  std::optional<Candidate> best;
  for (const Candidate& shift : candidates(find_shift_hints(reference), find_shift_hints(estimate))) {
    const Eigen::Vector3d& t = shift.translation_m;
    const double gap_m = gap_between(fixed, {moving.min + t, moving.max + t});
    if (gap_m >= smallest_m) continue;
    smallest_m = gap_m;
    best = shift;
  }
  if (best) evaluation.warnings.push_back({"shift_found", sentence(*best)});
}

}  // namespace cmap
