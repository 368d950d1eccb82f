#include "judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace cmap {
namespace {

// Chosen on random pairs of other seeds than the benchmark's, two places among them: benchmarks/registration.
constexpr double kScore = 0.7;       ///< of a right pose, at least
constexpr double kSupport = 20.0;    ///< witnesses that agree beyond chance, at least
constexpr double kAdvantage = 4.0;   ///< standard errors over every rival, at least
constexpr double kChallenges = 8.0;  ///< a rival with less advantage over it is settled too

constexpr std::size_t kMostSettled = 4, kMostRivals = 3;

void sort_by_evidence(std::vector<JudgedPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const JudgedPose& a, const JudgedPose& b) { return a.worth.evidence > b.worth.evidence; });
}

}  // namespace

Finalists finalists_of(PoseSearch& search, const std::vector<JudgedPose>& poses, const Similarity* first) {
  if (poses.empty() && first == nullptr) throw std::invalid_argument("no poses");
  const Similarity start = first != nullptr ? *first : search.settled(poses.front().local);
  const Chance chance = search.chance_about(start);
  std::vector<JudgedPose> judged{search.judge(start, chance)};
  for (const JudgedPose& pose : poses) {
    JudgedPose other = search.judge(pose.local, chance);
    if (judged.size() < kMostSettled && search.advantage_of(judged.front(), other, chance) < kChallenges) {
      other = search.judge(search.settled(pose.local), chance);
    }
    const auto is_apart = [&](const JudgedPose& o) { return search.apart_m(other.local, o.local) > search.distinct_m(); };
    if (std::all_of(judged.begin(), judged.end(), is_apart)) judged.push_back(other);
  }
  if (first == nullptr) sort_by_evidence(judged);
  Finalists finalists{judged.front(), {judged.begin() + 1, judged.end()}, {}, chance};
  sort_by_evidence(finalists.rivals);
  for (const JudgedPose& rival : finalists.rivals) {
    finalists.advantage.push_back(search.advantage_of(finalists.best, rival, chance));
  }
  return finalists;
}

Judgment judgment_of(const Finalists& finalists, const Eigen::Vector3d& source_origin,
                     const Eigen::Vector3d& target_origin) {
  const Worth& worth = finalists.best.worth;
  Judgment judgment;
  judgment.verdict = Verdict::kDetermined;
  judgment.score = worth.score;
  double least = kChallenges;
  for (std::size_t i = 0; i < finalists.rivals.size(); ++i) {
    least = std::min(least, finalists.advantage[i]);
    if (judgment.rivals.size() == kMostRivals) continue;
    const Similarity world = world_transform(finalists.rivals[i].local, source_origin, target_origin);
    judgment.rivals.push_back({world.matrix(), finalists.rivals[i].worth.score});
  }
  judgment.reason = fmt::format("{:.0f} % of what both maps show agrees beyond chance, {:.0f} places",
                                100.0 * worth.score, worth.support);
  if (worth.score < kScore || worth.support < kSupport) {
    judgment.verdict = Verdict::kUnsupported;
    judgment.help = "maps that share more, or an --initial transform near enough";
  } else if (least < kAdvantage) {
    judgment.verdict = Verdict::kAmbiguous;
    judgment.reason = fmt::format("another pose fits as well: this one is {:.1f} standard errors better", least);
    judgment.help = "an --initial transform near enough, with a method that starts from it";
  }
  return judgment;
}

}  // namespace cmap
