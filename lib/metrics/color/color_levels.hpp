#pragma once

#include <cstdint>
#include <vector>

#include "cmap/core/random_hash.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// Colors of the reference that one side's pairs are compared with, of at most 100,000 pairs that count (no farther
/// than that, where it is given): the nearest one's of estimated points, the own one of reference points.
inline std::vector<Eigen::Vector3d> compared_colors(LevelInputs& levels, Side side,
                                                    const std::optional<double>& farthest_m) {
  const NearestPairs pairs = levels.inputs.pairs(side);
  std::vector<Eigen::Vector3d> colors;
  for (const std::uint32_t slot : levels.sampled_slots(side)) {
    if (!pairs.has_colors(slot) || (farthest_m && !pairs.is_within(slot, *farthest_m))) continue;
    colors.push_back(side == Side::kEstimate ? pairs.to_color(slot) : pairs.from_color(slot));
  }
  return colors;
}

/// The mean difference between a drawn color and those: over all of both where they are few, else over one draw each.
template <class Color, class Difference>
Level drawn_level(const std::vector<Color>& drawn_from, const std::vector<Color>& compared, std::uint64_t seed,
                  Difference difference) {
  constexpr std::size_t kMostPairs = 1'000'000;
  std::vector<double> differences;
  if (drawn_from.size() * compared.size() <= kMostPairs) {
    for (const Color& color : compared) {
      for (const Color& drawn : drawn_from) differences.push_back(difference(drawn, color));
    }
    Level level = mean_level(differences);
    level.se = 0.0;
    level.n = compared.size();
    return level;
  }
  for (std::size_t i = 0; i < compared.size(); ++i) {
    differences.push_back(difference(drawn_from[random_below(drawn_from.size(), i, seed)], compared[i]));
  }
  return mean_level(differences);
}

/// Chance of a difference of colors, the mean of both sides'.
inline Level mean_of(const Level& a, const Level& b) {
  if (a.n == 0 || b.n == 0) return a.n == 0 ? a : b;
  return {0.5 * (a.value + b.value), 0.5 * std::hypot(a.se, b.se), a.n + b.n};
}

/// Both levels of a metric that is the mean difference of colors of pairs that count. `project` makes of a color
/// (1/255) what is compared.
template <class Project, class Difference>
Levels difference_levels(LevelInputs& levels, const std::optional<double>& farthest_m, Project project,
                         Difference difference) {
  using Color = decltype(project(Eigen::Vector3d()));
  const auto projected = [&](const std::vector<Eigen::Vector3d>& colors) {
    std::vector<Color> all;
    for (const Eigen::Vector3d& color : colors) all.push_back(project(color));
    return all;
  };
  const std::vector<Color> drawn_from = projected(levels.estimate_colors());
  const auto chance = [&](Side side, std::uint64_t seed) {
    return drawn_level(drawn_from, projected(compared_colors(levels, side, farthest_m)), seed, difference);
  };
  const IndexedMap& reference = levels.inputs.pair->reference;
  std::vector<double> own;
  for (const SelfPair& pair : self_pairs_within(levels, farthest_m)) {
    if (!reference.has_color_at(pair.slot) || !reference.has_color_at(pair.other)) continue;
    own.push_back(difference(project(reference.color(pair.slot)), project(reference.color(pair.other))));
  }
  Levels found;
  found.floor = mean_level(own);
  found.chance = mean_of(chance(Side::kEstimate, 1), chance(Side::kReference, 2));
  return found;
}

/// Of color distance.
const Levels& color_distance_levels(LevelInputs& levels);

}  // namespace cmap
