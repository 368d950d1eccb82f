#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

// How a metric is made: a source lib/metrics/{color,geometry,distribution,entropy,density}/NAME.cpp defines the Metric
// cmap::catalog::NAME, and the line of that name in the module's CMakeLists.txt puts it into metric_list() and
// cmap/metrics/catalog.hpp, and asks for tests/metrics/NAME_test.cpp. Command line, reports, tables, leaderboards and
// --help follow.

namespace cmap {

/// What is fixed about a metric: METRICS.md in one table.
struct MetricInfo {
  std::string_view id;
  std::string_view symbol = {};  ///< the paper's, or empty
  std::string_view title;        ///< for people
  std::string_view group;        ///< color, color+, geometry, distribution, mme, density
  std::string_view unit;
  std::string_view better = {};  ///< "lower", "higher"; empty where neither is
  std::string_view definition;   ///< a sentence or two for people
  bool needs_color = false;
  bool needs_reference = true;       ///< else it has a value for a map alone, and of a pair for each map
  bool per_threshold = false;        ///< has one value for each of `thresholds`
  bool share = false;                ///< a share of points, which people read in percent
  double paper_factor = 1.0;         ///< papers print the value times this ...
  std::string_view paper_unit = {};  ///< ... in this unit; empty: the metric's
};

/// Some thousand points of one side in consecutive slots, all of one part of space, and what several metrics read of
/// each: computed once.
struct PointRun {
  const MetricInputs& inputs;
  Side side;
  std::size_t begin = 0, size = 0;                        ///< slots
  std::span<const double> distance_m = {}, sq_dist = {};  ///< of the nearest point of the other map; empty without one
  /// To it, unit RGB; NaN where either has no color; empty without colors.
  std::span<const double> color_distance = {};
  /// The distances ordered by band: those of band b are at band_begin[b] to band_begin[b + 1].
  std::span<const std::size_t> band_begin = {};
  std::span<const double> banded_distance_m = {}, banded_sq_dist = {};

  std::span<const double> distances_in(std::size_t band) const { return of_band(banded_distance_m, band); }
  std::span<const double> squares_in(std::size_t band) const { return of_band(banded_sq_dist, band); }

 private:
  std::span<const double> of_band(std::span<const double> all, std::size_t band) const {
    return all.subspan(band_begin[band], band_begin[band + 1] - band_begin[band]);
  }
};

/// A metric's sums over either side by its columns; empty for a side that it does not sum, or that is not there.
using PairSums = BothSides<std::span<const double>>;

/// A voxel's terms, one for each column; it lies in the part of space in which its center does.
struct VoxelTerms {
  VoxelIndex index;  ///< floor(world / voxel_m)
  double voxel_m;
  std::span<const double> terms;
};

/// An order statistic of one side's distances: of the n_first lowest the quantile `share` (type 7).
struct DistanceQuantile {
  Side side;
  std::uint64_t n_first;
  double share;
};

enum class Sides : std::uint8_t { kBoth, kEstimate, kReference };

class LevelInputs;

/// What a metric is; functions that it has no use for are null. All are pure but for `prepare`.
struct Metric {
  MetricInfo info;
  /// Makes the fields of MetricInputs that the metric reads.
  void (*prepare)(MetricInputs&) = nullptr;
  /// The metric whose columns and sums it takes in place of its own.
  const Metric* sums_of = nullptr;
  Sides sides = Sides::kBoth;
  /// What is summed, by name; saved reports keep the sums of blocks by these names.
  std::vector<std::string> (*columns)(const MetricSettings&) = nullptr;
  /// Adds the terms of a run of points to the columns' sums.
  void (*add)(const PointRun&, std::span<ExactSum> sums) = nullptr;
  /// In place of `add`, for metrics of voxels: all of a side's voxels, each on its own, or their sums.
  void (*each_voxel)(const MetricInputs&, Side, const std::function<void(const VoxelTerms&)>& use) = nullptr;
  void (*add_voxels)(const MetricInputs&, Side, std::span<ExactSum> sums) = nullptr;
  /// The formula: all that follows from the sums, whether of the whole maps, of a part or of a bootstrap's draw.
  Record (*value)(const PairSums&, const MetricSettings&) = nullptr;
  /// The order statistics that `finish` is given.
  std::vector<DistanceQuantile> (*quantiles)(const PairSums&, const MetricInputs&) = nullptr;
  /// Adds what does not follow from sums, and says what a user should know.
  void (*finish)(Record&, const MetricInputs&, std::span<const double> quantiles, std::vector<Warning>&) = nullptr;
  /// Adds what the value of a pair is worth (levels.hpp): floor, chance, skill.
  void (*levels)(Record&, LevelInputs&, std::vector<Warning>&) = nullptr;
};

/// All metrics, in the order of reports.
std::span<const Metric* const> metric_list();

/// By id; nullptr if there is none.
const Metric* metric_of(std::string_view id);

}  // namespace cmap
