#include "verdict/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

// Chosen on random pairs of other seeds than the benchmark's, two places among them: benchmarks/registration.
constexpr double kSupport = 25.0;  ///< witnesses that agree beyond chance, at least
/// Share of both maps, or, of many places, a little less; where neither is, they must agree as samples of one map do. A
/// stadium turned by 180 degrees explains up to 0.44 in 280 places, and agrees up to 0.91 as well.
constexpr double kExplained = 0.50, kExplainedByMany = 0.40, kMany = 350.0;
constexpr double kRelative = 0.94;                     ///< at either reach
constexpr double kScore = 0.45, kScoreOfLittle = 0.6;  ///< at least, where enough is explained and where not
constexpr double kAdvantage = 4.0;                     ///< standard errors over every rival, at least
constexpr double kChallenges = 8.0;                    ///< a rival with less advantage over it is settled too
constexpr double kMirrorBetter = 2.0;                  ///< times the evidence

constexpr std::size_t kAlwaysSettled = 2, kMostSettled = 4, kMostRivals = 3;

void sort_by_evidence(std::vector<JudgedPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const JudgedPose& a, const JudgedPose& b) { return a.worth.evidence > b.worth.evidence; });
}

/// Whether the source's mirror image fits where the source does not. It may stand on its head, as where z points down:
/// the source is left standing like the target.
bool is_mirrored(PoseSearch& search, const Worth& than) {
  search.stand_like_target();
  const std::vector<JudgedPose> mirrored = search.search(true);
  if (mirrored.empty()) return false;
  const Fit fit = fit_at(search, search.settled(mirrored.front().local));
  return fit.convinces() && fit.worth.evidence > kMirrorBetter * than.evidence;
}

std::string fit_text(const Fit& fit) {
  return fmt::format("beyond chance {:.0f} % of what both maps show agrees, {:.0f} places and {:.0f} % of the maps",
                     100.0 * fit.worth.score, fit.worth.support, 100.0 * fit.explained);
}

void say_unsupported(const Fit& fit, Judgment& judgment) {
  judgment.verdict = Verdict::kUnsupported;
  judgment.reason = "too little in common to tell: " + fit_text(fit);
  if (fit.worth.score >= kScore && fit.worth.support >= kSupport) {
    judgment.reason += fmt::format(", no nearer than {:.0f} % of what samples of one map would",
                                   100.0 * std::min(fit.relative_8, fit.relative_16));
  }
  judgment.help = "maps that share more, --method global, or a nearer start by --initial";
}

void say_ambiguous(double least_advantage, Judgment& judgment) {
  judgment.verdict = Verdict::kAmbiguous;
  judgment.reason = least_advantage < 0.0
                        ? fmt::format("another pose fits better, by {:.1f} standard errors", -least_advantage)
                        : fmt::format(
                              "another pose fits as well: this one is better by {:.1f} standard errors, and {:g} "
                              "are needed",
                              least_advantage, kAdvantage);
  judgment.help = least_advantage < -kAdvantage ? "--method global" : "a start near the right pose by --initial";
}

}  // namespace

Finalists finalists_of(PoseSearch& search, const std::vector<JudgedPose>& poses, const Similarity* first) {
  if (poses.empty() && first == nullptr) throw std::invalid_argument("no poses");
  const Similarity start = first != nullptr ? *first : search.settled(poses.front().local);
  const Chance chance = search.chance_about(start);
  std::vector<JudgedPose> judged{search.judge(start, chance)};
  for (const JudgedPose& pose : poses) {
    JudgedPose other = search.judge(pose.local, chance);
    const bool challenges = search.advantage_of(judged.front(), other, chance) < kChallenges;
    if (judged.size() < kAlwaysSettled || (challenges && judged.size() < kMostSettled)) {
      other = search.judge(search.settled(pose.local), chance);
    }
    const auto is_apart = [&](const JudgedPose& o) {
      return search.apart_m(other.local, o.local) > search.distinct_m();
    };
    if (std::all_of(judged.begin(), judged.end(), is_apart)) judged.push_back(other);
  }
  if (first == nullptr) sort_by_evidence(judged);
  Finalists finalists{judged.front(), {judged.begin() + 1, judged.end()}, {}};
  sort_by_evidence(finalists.rivals);
  for (const JudgedPose& rival : finalists.rivals) {
    finalists.advantage.push_back(search.advantage_of(finalists.best, rival, chance));
  }
  return finalists;
}

bool Fit::convinces() const {
  if (worth.score < kScore || worth.support < kSupport) return false;
  if (explained >= kExplained || (explained >= kExplainedByMany && worth.support >= kMany)) return true;
  return worth.score >= kScoreOfLittle && std::min(relative_8, relative_16) >= kRelative;
}

Fit fit_at(PoseSearch& search, const Similarity& local) {
  Fit fit;
  const double reach_m = search.reach_m();
  const auto relative = [&](double divisor) {
    search.set_reach_m(search.voxel_m() / divisor);
    const Chance chance = search.chance_about(local);
    const JudgedPose pose = search.judge(local, chance);
    const double best = search.best_worth_of(pose, chance).score;
    return best > 0.0 ? pose.worth.score / best : 0.0;
  };
  const Chance chance = search.chance_about(local);
  fit.worth = search.judge(local, chance).worth;
  fit.explained = fit.worth.support / search.possible_support(chance);
  fit.relative_8 = relative(8.0);
  fit.relative_16 = relative(16.0);
  search.set_reach_m(reach_m);
  return fit;
}

Judgment judgment_of(PoseSearch& search, const Similarity& local, const Finalists& finalists,
                     const Eigen::Vector3d& source_origin, const Eigen::Vector3d& target_origin) {
  const Fit fit = fit_at(search, local);
  Judgment judgment;
  judgment.verdict = Verdict::kDetermined;
  judgment.score = fit.worth.score;
  judgment.reason = fit_text(fit);
  double least = kChallenges;
  for (std::size_t i = 0; i < finalists.rivals.size(); ++i) {
    least = std::min(least, finalists.advantage[i]);
    if (judgment.rivals.size() == kMostRivals) continue;
    const Similarity world = world_transform(finalists.rivals[i].local, source_origin, target_origin);
    judgment.rivals.push_back({world.matrix(), finalists.rivals[i].worth.score});
  }
  if (!fit.convinces()) {
    say_unsupported(fit, judgment);
  } else if (least < kAdvantage) {
    say_ambiguous(least, judgment);
  }
  if (!is_trusted(judgment.verdict) && is_mirrored(search, fit.worth)) {
    judgment.verdict = Verdict::kMirrored;
    judgment.reason = "the mirror image of the source fits and the source does not: one of the two is left-handed";
    judgment.help = "an export with axes of the same hand";
  }
  return judgment;
}

void tell_weak(const Alignment& found, Judgment& judgment) {
  constexpr double kWeakVoxels = 0.2;  // of the finest level
  if (judgment.verdict != Verdict::kDetermined) return;
  for (const WeakDirection& direction : found.standard_errors) {
    if (direction.standard_error_m > kWeakVoxels * found.voxel_m) judgment.weak.push_back(direction);
  }
  if (!judgment.weak.empty()) judgment.verdict = Verdict::kWeak;
}

Judgment judge_alignment(const PointCloud& source, const PointCloud& target, const Alignment& found) {
  const Similarity T = similarity_from(found.T_dst_src);
  const PointCloud scaled = scaled_by(T.scale, source);
  const Similarity rigid{1.0, T.rotation, T.translation};
  PoseSearch search(scaled, target, search_voxel_m(scaled, target));
  const Similarity local = local_transform(rigid, scaled.origin, target.origin);
  search.stand_as(local);
  Judgment judgment =
      judgment_of(search, local, finalists_of(search, search.search(), &local), scaled.origin, target.origin);
  for (RivalPose& rival : judgment.rivals) rival.T_dst_src.topLeftCorner<3, 3>() *= T.scale;
  tell_weak(found, judgment);
  return judgment;
}

}  // namespace cmap
