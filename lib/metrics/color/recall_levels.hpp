#pragma once

#include <vector>

#include "cmap/metrics/levels.hpp"

namespace cmap {

/// Of how many reference points levels are found.
struct RecallSamples {
  std::size_t floor = 100'000, chance = 20'000;
};

/// Both levels of local color recall at one radius, for each tau: the floor from each reference point's own map, its
/// own entry left out; the chance 1 - (1 - q)^n of each, n estimated points within the radius and a share q of the
/// estimate's colors within 3 tau.
std::vector<Levels> recall_levels(LevelInputs& levels, double radius_m, const std::vector<double>& taus,
                                  const RecallSamples& samples = {});

/// Skill at a small grid of radii and tau around the options', from some 2,000 reference points.
struct SkillMap {
  struct Row {
    double radius_m;
    std::vector<Level> value, skill;  ///< by tau
    std::vector<Levels> levels;
  };
  std::vector<double> taus;
  std::uint64_t n = 0;  ///< reference points
  std::vector<Row> rows;
};
SkillMap skill_map(LevelInputs& levels);

}  // namespace cmap
