#include "cmap/align/trust.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>

#include "cmap/core/error.hpp"
#include "cmap/geometry/similarity.hpp"
#include "direction_text.hpp"

namespace cmap {
namespace {

std::string weak_text(const WeakDirection& weak) {
  return fmt::format("{} is only weakly determined: standard error {:.3g} m", weak.name, weak.standard_error_m);
}

/// The worst weak direction, where it is worse than the rule allows.
const WeakDirection* too_weak(const Judgment& judgment, const TrustRule& rule) {
  if (judgment.verdict != Verdict::kWeak || judgment.weak.empty()) return nullptr;
  const WeakDirection& worst = judgment.weak.front();
  return worst.standard_error_m < rule.largest_error_m ? nullptr : &worst;
}

/// Why it is not to be trusted; empty where it is.
std::string distrust(const Judgment& judgment, const TrustRule& rule) {
  if (!is_trusted(judgment.verdict)) {
    return fmt::format("the alignment is {}: {}", name_of(judgment.verdict, verdict_names()), judgment.reason);
  }
  const WeakDirection* worst = too_weak(judgment, rule);
  if (worst == nullptr) return {};
  return fmt::format("the alignment is weak: {}, and no more than {:.3g} m is accepted", weak_text(*worst),
                     rule.largest_error_m);
}

/// How a rival differs from what was found.
std::string rival_text(const RivalPose& rival, const Eigen::Matrix4d& T_dst_src) {
  const Similarity found = similarity_from(T_dst_src), other = similarity_from(rival.T_dst_src);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(other.rotation * found.rotation.transpose()));
  const Eigen::Vector3d shift_m = other.translation - found.translation;
  return fmt::format("score {:.3g}, turned {:.1f} degrees about {} from this one, translation {:.3g} m from its",
                     rival.score, turn.angle() * 180.0 / M_PI, direction_text(turn.axis()), shift_m.norm());
}

}  // namespace

void require_trust(Alignment& alignment, const TrustRule& rule) {
  const Judgment& judgment = alignment.judgment;
  const std::string reason = distrust(judgment, rule);
  const std::string help = judgment.help.empty() ? "" : "; " + judgment.help;
  if (!reason.empty() && !rule.allow_unconverged) {
    throw UnsupportedError(fmt::format("{}{}; --allow-unconverged takes it all the same", reason, help));
  }
  if (!reason.empty()) alignment.warnings.push_back(reason + help);
  if (judgment.verdict != Verdict::kWeak) return;
  for (const WeakDirection& weak : judgment.weak) alignment.warnings.push_back(weak_text(weak));
}

std::string verdict_lines(const Alignment& alignment) {
  const Judgment& judgment = alignment.judgment;
  if (judgment.verdict == Verdict::kNotJudged) return {};
  std::string text;
  const auto add = [&](std::string_view name, std::string_view what) {
    fmt::format_to(std::back_inserter(text), "{:<11} {}\n", name, what);
  };
  const std::string_view name = name_of(judgment.verdict, verdict_names());
  add("verdict", judgment.reason.empty() ? std::string(name) : fmt::format("{}   {}", name, judgment.reason));
  for (const RivalPose& rival : judgment.rivals) add("rival", rival_text(rival, alignment.T_dst_src));
  for (const WeakDirection& weak : judgment.weak) {
    add("weak", fmt::format("{}, standard error {:.3g} m", weak.name, weak.standard_error_m));
  }
  if (!judgment.help.empty()) add("help", judgment.help);
  return text;
}

}  // namespace cmap
