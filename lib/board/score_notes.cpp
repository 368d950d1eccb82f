#include "score_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace cmap {
namespace {

/// As many digits as say how far a spread reaches.
std::string two_digits(double value) {
  constexpr double kLeastOfWhole = 9.95;
  return value == 0.0 ? "0" : value < kLeastOfWhole ? fmt::format("{:#.2g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace

std::string note_on(const Score* score) {
  if (score == nullptr) return "no value";
  std::string text = score->value ? fmt::format("{}", *score->value) : "no value";
  if (!score->reason.empty()) text += fmt::format(": {}", score->reason);
  if (score->floor) text += fmt::format("; floor {:.4g}", *score->floor);
  if (score->chance) text += fmt::format("{} chance {:.4g}", score->floor ? "," : ";", *score->chance);
  if (score->phases) text += fmt::format("; grid phases {:.4g} to {:.4g}", score->phases->min, score->phases->max);
  return text;
}

std::string band_of(const Score* score, double factor) {
  return score == nullptr || !score->phases ? "" : fmt::format("± {}", two_digits(factor * score->phases->std));
}

std::vector<std::string> missing_notes(const std::vector<std::string>& names,
                                       const std::vector<std::vector<Score>>& scores,
                                       const std::vector<ScoreKind>& kinds) {
  std::vector<std::string> notes;
  for (const ScoreKind& kind : kinds) {
    std::map<std::string, std::vector<std::string>> by_reason;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const Score* score = score_of(scores[i], kind);
      if (score != nullptr && !score->value && !score->reason.empty()) by_reason[score->reason].push_back(names[i]);
    }
    for (const auto& [reason, of] : by_reason)
      notes.push_back(fmt::format("no {}: {} ({})", kind.title, reason, fmt::join(of, ", ")));
  }
  return notes;
}

}  // namespace cmap
