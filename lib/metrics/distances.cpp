#include "cmap/metrics/distances.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "cmap/metrics/order_statistics.hpp"

namespace cmap {
namespace {

struct Band {
  std::uint64_t n = 0;
  double sum = 0.0;
  double sum_sq = 0.0;
  Band& operator+=(const Band& other) {
    n += other.n;
    sum += other.sum;
    sum_sq += other.sum_sq;
    return *this;
  }
};

/// Sums of the distances between successive sorted thresholds; the last band is beyond all.
struct Bands {
  std::vector<Band> bands;
  double truncated_sum = 0.0;
  double max_sq = 0.0;
  Bands& operator+=(const Bands& other) {
    bands.resize(other.bands.size());
    for (std::size_t b = 0; b < bands.size(); ++b) bands[b] += other.bands[b];
    truncated_sum += other.truncated_sum;
    max_sq = std::max(max_sq, other.max_sq);
    return *this;
  }
};

Bands sum_bands(std::span<const double> sq_dist, const std::vector<double>& sorted_thresholds, double truncation_m,
                const DistanceRounding& rounding) {
  return ordered_sum<Bands>(sq_dist.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    Bands sums;
    sums.bands.resize(sorted_thresholds.size() + 1);
    for (std::size_t i = begin; i < end; ++i) {
      const double distance = std::sqrt(sq_dist[i]);
      std::size_t b = 0;
      while (b < sorted_thresholds.size() && distance > sorted_thresholds[b]) ++b;
      while (b > 0 && distance <= sorted_thresholds[b - 1] + rounding.most_m &&
             distance <= sorted_thresholds[b - 1] + rounding.of_pair_m(i)) {
        --b;
      }
      sums.bands[b] += {1, distance, sq_dist[i]};
      sums.truncated_sum += std::min(distance, truncation_m);
      sums.max_sq = std::max(sums.max_sq, sq_dist[i]);
    }
    return sums;
  });
}

}  // namespace

DistanceStats distance_stats(std::span<const double> sq_dist, std::span<const double> thresholds_m, double truncation_m,
                             const DistanceRounding& rounding) {
  if (sq_dist.empty()) throw std::invalid_argument("distance_stats: no distances");
  std::vector<double> sorted(thresholds_m.begin(), thresholds_m.end());
  std::sort(sorted.begin(), sorted.end());
  Bands sums = sum_bands(sq_dist, sorted, truncation_m, rounding);
  for (std::size_t b = 1; b < sums.bands.size(); ++b) sums.bands[b] += sums.bands[b - 1];

  const auto n = static_cast<double>(sq_dist.size());
  std::vector<PrefixQuantile> wanted{{sq_dist.size(), 0.95}, {sq_dist.size(), 0.99}};
  DistanceStats stats;
  for (double threshold : thresholds_m) {
    const auto place = std::lower_bound(sorted.begin(), sorted.end(), threshold) - sorted.begin();
    const Band& band = sums.bands[static_cast<std::size_t>(place)];
    const auto n_within = static_cast<double>(band.n);  // 0 / 0 is NaN: missing
    stats.within.push_back({threshold, band.n, band.sum / n_within, std::sqrt(band.sum_sq / n_within), 0.0});
    wanted.push_back({band.n, 0.5});
  }
  const std::vector<double> ranked = prefix_quantiles(sq_dist, wanted, [](double sq) { return std::sqrt(sq); });
  for (std::size_t t = 0; t < stats.within.size(); ++t) stats.within[t].median_m = ranked[t + 2];

  stats.n = sq_dist.size();
  stats.mean_m = sums.bands.back().sum / n;
  stats.mean_sq_m2 = sums.bands.back().sum_sq / n;
  stats.mean_truncated_m = sums.truncated_sum / n;
  stats.max_m = std::sqrt(sums.max_sq);
  stats.p95_m = ranked[0];
  stats.p99_m = ranked[1];
  return stats;
}

}  // namespace cmap
