#pragma once

#include <string>
#include <vector>

#include "scores.hpp"

namespace cmap {

/// All digits, and what the number is worth: "0.1014; floor 0.0741, chance 0.3; grid phases 0.1 to 0.2". Else that
/// there is no value, and why; null is a score that the report does not have.
std::string note_on(const Score* score);

/// "± 0.097", in the unit that `factor` makes of the score's; empty for a score without phases.
std::string band_of(const Score* score, double factor = 1.0);

/// "no skill of color distance: the floor is no better than chance (a, b)", for each score of which reports say why
/// they have none. Names are by report.
std::vector<std::string> missing_notes(const std::vector<std::string>& names,
                                       const std::vector<std::vector<Score>>& scores,
                                       const std::vector<ScoreKind>& kinds);

}  // namespace cmap
