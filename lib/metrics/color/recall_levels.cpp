#include "color/recall_levels.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "cmap/core/parallel.hpp"
#include "cmap/core/sampled_indices.hpp"
#include "cmap/spatial/within.hpp"

namespace cmap {
namespace {

constexpr std::size_t kQueryChunk = 64;

/// At most n slots of reference points that have a color.
std::vector<std::uint32_t> colored_slots(LevelInputs& levels, std::size_t n) {
  const IndexedMap& reference = levels.inputs.pair->reference;
  std::vector<std::uint32_t> slots = levels.sampled_slots(Side::kReference, n);
  std::erase_if(slots, [&](std::uint32_t slot) { return !reference.has_color_at(slot); });
  return slots;
}

/// The reference's points in a map's offsets.
class Queries {
 public:
  Queries(const IndexedMap& from, const IndexedMap& to)
      : from_(from), shift_(from.index.points.origin - to.index.points.origin) {}
  Eigen::Vector3f place(std::uint32_t slot) const { return from_.index.points.offset(slot) + shift_.cast<float>(); }

 private:
  const IndexedMap& from_;
  Eigen::Vector3d shift_;
};

/// The squared distance (1/255) from each point's color to the most similar one of `in` within the radius: exact above
/// `stop_at`. A point of `in` itself is left out. guess(slot) is a slot of `in` that is likely to be near.
template <class Guess>
std::vector<double> best_colors(const IndexedMap& reference, std::span<const std::uint32_t> slots, const IndexedMap& in,
                                double radius_m, double stop_at, Guess guess) {
  const PointsWithin within(in.index, radius_m);
  const Queries queries(reference, in);
  const bool own_map = &reference == &in;
  std::vector<double> best(slots.size(), std::numeric_limits<double>::infinity());
  parallel_chunks(slots.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d color = reference.color(slots[i]);
      within.any(queries.place(slots[i]), guess(slots[i]), [&](std::size_t slot) {
        if (own_map && slot == slots[i]) return false;
        const double sq_color = (in.color(slot) - color).squaredNorm();
        if (sq_color < best[i]) best[i] = sq_color;  // never of a missing color
        return best[i] <= stop_at;
      });
    }
  });
  return best;
}

Level share_right(std::span<const double> best, double tau) {
  const double right = right_color_limit(tau);
  const auto n = std::ranges::count_if(best, [&](double sq_color) { return sq_color <= right; });
  return share_level(static_cast<std::uint64_t>(n), best.size());
}

/// Colors, a channel after the other.
struct ColorList {
  std::vector<float> r, g, b;
};

/// At most 8192 of them, evenly spread along a curve through the space of colors: of a ball's share such a sample knows
/// far more than one drawn at random.
ColorList spread_colors(const std::vector<Eigen::Vector3d>& colors) {
  constexpr std::size_t kMost = 8192;
  if (colors.empty()) return {};
  PointCloud cloud;
  for (const Eigen::Vector3d& color : colors) cloud.positions.push_back(color.cast<float>());
  const PointBlocks sorted = sort_points(cloud);
  ColorList list;
  for (const std::size_t slot : sampled_indices(sorted.size, kMost)) {
    const Eigen::Vector3f color = sorted.offset(slot);
    list.r.push_back(color.x());
    list.g.push_back(color.y());
    list.b.push_back(color.z());
  }
  return list;
}

/// How many of them are no farther (squared, 1/255) than `right` from a color.
int count_similar(const ColorList& colors, const Eigen::Vector3f& color, float right) {
  const float *r = colors.r.data(), *g = colors.g.data(), *b = colors.b.data();
  const auto n = static_cast<int>(colors.r.size());
  int n_similar = 0;
  for (int i = 0; i < n; ++i) {
    const float dr = r[i] - color.x(), dg = g[i] - color.y(), db = b[i] - color.z();
    n_similar += dr * dr + dg * dg + db * db <= right ? 1 : 0;
  }
  return n_similar;
}

/// The share of the estimate's colors within 3 tau of each point's.
std::vector<double> similar_shares(const IndexedMap& reference, std::span<const std::uint32_t> slots,
                                   const ColorList& colors, double tau) {
  const float right = right_color_limit(tau);
  std::vector<double> shares(slots.size());
  parallel_chunks(slots.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int n = count_similar(colors, color_at(reference.colors, slots[i]), right);
      shares[i] = static_cast<double>(n) / static_cast<double>(colors.r.size());
    }
  });
  return shares;
}

std::vector<double> numbers_within(const IndexedMap& reference, std::span<const std::uint32_t> slots,
                                   const IndexedMap& estimate, double radius_m) {
  const PointsWithin within(estimate.index, radius_m);
  const Queries queries(reference, estimate);
  std::vector<double> numbers(slots.size());
  parallel_chunks(slots.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) numbers[i] = static_cast<double>(within.count(queries.place(slots[i])));
  });
  return numbers;
}

/// The mean of 1 - (1 - q)^n.
Level chance_of(std::span<const double> shares, std::span<const double> numbers) {
  std::vector<double> chances;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const bool never = numbers[i] == 0.0 || shares[i] == 0.0;
    chances.push_back(never ? 0.0 : -std::expm1(numbers[i] * std::log1p(-std::min(shares[i], 1.0))));
  }
  return mean_level(chances);
}

class RecallLevels {
 public:
  RecallLevels(LevelInputs& levels, const std::vector<double>& taus, const RecallSamples& samples)
      : reference_(levels.inputs.pair->reference),
        estimate_(levels.inputs.estimate),
        nearest_in_estimate_(levels.inputs.pair->nearest_in_estimate),
        taus_(taus),
        of_floor_(colored_slots(levels, samples.floor)),
        of_chance_(colored_slots(levels, samples.chance)) {
    const ColorList colors = spread_colors(levels.estimate_colors());
    for (const double tau : taus) shares_.push_back(similar_shares(reference_, of_chance_, colors, tau));
  }

  /// By tau.
  std::vector<Levels> at(double radius_m) const {
    const std::vector<double> best =
        best_colors(reference_, of_floor_, reference_, radius_m, stop_at(), std::identity());
    const std::vector<double> numbers = numbers_within(reference_, of_chance_, estimate_, radius_m);
    std::vector<Levels> found(taus_.size());
    for (std::size_t i = 0; i < taus_.size(); ++i) {
      found[i].floor = share_right(best, taus_[i]);
      found[i].chance = chance_of(shares_[i], numbers);
    }
    return found;
  }

  /// Recall itself, over the floor's points; by tau.
  std::vector<Level> values_at(double radius_m) const {
    const auto nearest = [&](std::uint32_t slot) { return nearest_in_estimate_.slot[slot]; };
    const std::vector<double> best = best_colors(reference_, of_floor_, estimate_, radius_m, stop_at(), nearest);
    std::vector<Level> values;
    for (const double tau : taus_) values.push_back(share_right(best, tau));
    return values;
  }

  std::uint64_t n() const { return of_floor_.size(); }

 private:
  double stop_at() const { return right_color_limit(std::ranges::min(taus_)); }

  const IndexedMap &reference_, &estimate_;
  const NearestField& nearest_in_estimate_;
  const std::vector<double>& taus_;
  std::vector<std::uint32_t> of_floor_, of_chance_;
  std::vector<std::vector<double>> shares_;  ///< by tau
};

}  // namespace

std::vector<Levels> recall_levels(LevelInputs& levels, double radius_m, const std::vector<double>& taus,
                                  const RecallSamples& samples) {
  return RecallLevels(levels, taus, samples).at(radius_m);
}

SkillMap skill_map(LevelInputs& levels) {
  constexpr std::size_t kPoints = 2'000;
  const MetricOptions& o = levels.inputs.options();
  SkillMap map;
  for (const double factor : {0.2, 0.5, 1.0, 2.0}) map.taus.push_back(factor * o.lcr_tau);
  const RecallLevels found(levels, map.taus, {.floor = kPoints, .chance = kPoints});
  map.n = found.n();
  for (const double factor : {0.05, 0.1, 0.2, 0.5, 1.0}) {
    const double radius_m = factor * o.lcr_radius_m;
    SkillMap::Row row{radius_m, found.values_at(radius_m), {}, found.at(radius_m)};
    for (std::size_t i = 0; i < map.taus.size(); ++i) {
      row.skill.push_back(skill_of(row.value[i].value, row.levels[i], "higher"));
    }
    map.rows.push_back(std::move(row));
  }
  return map;
}

}  // namespace cmap
