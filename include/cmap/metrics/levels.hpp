#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

// What a number is worth ("Levels" of METRICS): its floor, which a perfect map could be expected to score; for colors
// its chance, expected where every estimated point draws its color from all of the estimate's; and the skill between.

namespace cmap {

struct Metric;
struct MetricRecord;

/// A level with its standard error and what it was found from; without a value (NaN) it says why.
struct Level {
  double value = NAN, se = NAN;
  std::uint64_t n = 0;
  std::string reason = {};
};

/// Both levels of a metric.
struct Levels {
  Level floor, chance;
};

/// A point of the reference and its nearest other entry: the lowest original index among the nearest.
struct SelfPair {
  std::uint32_t slot, other;
  double distance_m;
  double rounding_m;  ///< as far above a threshold it counts as at it (spatial/threshold.hpp)
};

/// What the levels of several metrics are found from, each made when it is first asked for. Not thread-safe.
class LevelInputs {
 public:
  explicit LevelInputs(const MetricInputs& metric_inputs) : inputs(metric_inputs) {}

  /// At most n slots of a side's points (n at most 100,000): all, or those with the lowest hashes of the original
  /// index; ascending.
  std::vector<std::uint32_t> sampled_slots(Side side, std::size_t n = kMostSampled);

  /// Of all points of the reference, or of 100,000; none of a single point.
  const std::vector<SelfPair>& self_pairs();
  /// Colors of the estimate's points in units of 1/255: of all that have one, or of as many.
  const std::vector<Eigen::Vector3d>& estimate_colors();
  /// Of color distance, for whoever follows from it.
  std::optional<Levels> color_distance = {};

  const MetricInputs& inputs;

  static constexpr std::size_t kMostSampled = 100'000;

 private:
  BothSides<std::optional<std::vector<std::uint32_t>>> by_hash_;  ///< the sample, the lowest hash first
  std::optional<std::vector<SelfPair>> self_pairs_;
  std::optional<std::vector<Eigen::Vector3d>> estimate_colors_;
};

/// The mean, its standard error; root mean square; a share of n; each missing where n is 0.
Level mean_level(std::span<const double> values);
Level rms_level(std::span<const double> values);
Level share_level(std::uint64_t n_in, std::uint64_t n);
Level scaled(Level level, double factor);

/// The self pairs within a threshold, as METRICS means it; all without one.
std::vector<SelfPair> self_pairs_within(LevelInputs& levels, const std::optional<double>& threshold_m);
/// Their distances, and their share of all.
std::vector<double> self_distances(LevelInputs& levels, const std::optional<double>& threshold_m = {});
Level self_share(LevelInputs& levels, double threshold_m);

/// The mean distance between two halves of the reference, over voxels of at least min_points of both; missing below 20.
Level halves_level(std::span<const double> distances, double voxel_m, std::uint64_t min_points);

/// Adds {floor: {value, se, n}} or {value: null, n, reason}; and skill where both levels are there.
void add_floor(Record& record, const Level& floor);
void add_chance(Record& record, const Level& chance);
void add_levels_of(Record& record, const Levels& levels, std::string_view better);

/// (chance - value) / (chance - floor), with the standard error that both levels give it; a reason where it has none.
Level skill_of(double value, const Levels& levels, std::string_view better);

/// Adds the levels of all metrics to their records.
void add_levels(std::span<const Metric* const> metrics, std::vector<MetricRecord>& records, LevelInputs& levels,
                std::vector<Warning>& warnings);

/// Adds {phases: {n, mean, std, min, max, values}}; nothing of a single phase.
void add_phases(Record& record, std::span<const double> values);

/// One warning for all records whose phases differ by more than a tenth (std over mean).
void warn_of_phases(std::span<const MetricRecord> records, std::vector<Warning>& warnings);

}  // namespace cmap
