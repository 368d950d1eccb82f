#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "cmap/metrics/metric_sums.hpp"

namespace cmap {

/// The sums of a pair's metrics over cubic blocks of space, by which points of one place stay together: errors of
/// neighboring points are alike, so that single points say less than they seem to.
struct BlockSums {
  double block_m = 0.0;
  std::vector<std::array<std::int64_t, 3>> keys;  ///< floor(world / block_m) of the parts, ascending
  MetricSums sums;
};

inline constexpr std::uint64_t kMostReplicates = 1'000'000;

/// What is fixed about a bootstrap; the seed makes it repeatable on every machine. No two seeds share a replicate.
struct BootstrapOptions {
  std::uint64_t n_replicates = 1000;  ///< at most kMostReplicates
  double level = 0.95;
  std::uint64_t seed = 1;
};

/// A value, and the percentiles of its replicates that hold the level between them; NaN where more than a tenth of the
/// replicates have no value.
struct Interval {
  std::string_view id;
  std::optional<double> threshold_m;
  double value, lower, upper;
};

/// Intervals of an evaluation, and what they were drawn from.
struct Intervals {
  BootstrapOptions options;
  BlockSums blocks;
  std::vector<Interval> metrics;
};

/// Spatial block bootstrap (Efron and Tibshirani 1993, chapter 13; blocks after Kuensch 1989): every replicate draws as
/// many blocks as there are, with replacement, and computes every metric from their sums by its own formula.
std::vector<Interval> bootstrap(const BlockSums& blocks, const MetricSettings& settings,
                                const BootstrapOptions& options);

/// The same for the difference b - a of two estimates on one reference, each with its own settings: both are computed
/// from the same drawn blocks, so that what is hard for both cancels. Throws std::invalid_argument where the blocks'
/// sizes differ.
std::vector<Interval> bootstrap_difference(const BlockSums& a, const MetricSettings& settings_a, const BlockSums& b,
                                           const MetricSettings& settings_b, const BootstrapOptions& options);

}  // namespace cmap
