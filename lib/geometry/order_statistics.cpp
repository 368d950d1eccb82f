#include "cmap/geometry/order_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

namespace cmap {
namespace {

// The upper bits of a non-negative double order like the double: 11 bits of exponent and 5 of mantissa.
constexpr int kBucketShift = 64 - 17;
constexpr std::size_t kBuckets = std::size_t{1} << 16;

std::size_t bucket_of(double value) { return std::bit_cast<std::uint64_t>(value + 0.0) >> kBucketShift; }

/// The order statistics at the given ranks, which must be below the number of values.
std::map<std::uint64_t, double> order_statistics(std::span<const double> values, std::vector<std::uint64_t> ranks) {
  std::vector<std::uint64_t> first_rank(kBuckets + 1, 0);
  for (double v : values) ++first_rank[bucket_of(v) + 1];
  for (std::size_t b = 1; b <= kBuckets; ++b) first_rank[b] += first_rank[b - 1];

  std::map<std::size_t, std::vector<double>> members;
  const auto bucket_at = [&](std::uint64_t rank) {
    return static_cast<std::size_t>(std::upper_bound(first_rank.begin(), first_rank.end(), rank) - first_rank.begin() -
                                    1);
  };
  for (std::uint64_t rank : ranks) members[bucket_at(rank)];
  std::vector<std::vector<double>*> collect(kBuckets, nullptr);
  for (auto& [bucket, list] : members) collect[bucket] = &list;
  for (double v : values) {
    if (auto* list = collect[bucket_of(v)]) list->push_back(v);
  }

  std::map<std::uint64_t, double> statistics;
  for (std::uint64_t rank : ranks) {
    const std::size_t bucket = bucket_at(rank);
    std::vector<double>& list = members[bucket];
    const auto nth = list.begin() + static_cast<std::ptrdiff_t>(rank - first_rank[bucket]);
    std::nth_element(list.begin(), nth, list.end());
    statistics[rank] = *nth;
  }
  return statistics;
}

}  // namespace

std::vector<double> prefix_quantiles(std::span<const double> values, std::span<const PrefixQuantile> wanted,
                                     double (*measure)(double)) {
  const auto rank_of = [](const PrefixQuantile& q) { return static_cast<double>(q.n_first - 1) * q.share; };
  std::vector<std::uint64_t> ranks;
  for (const PrefixQuantile& q : wanted) {
    if (q.n_first == 0) continue;
    ranks.push_back(static_cast<std::uint64_t>(std::floor(rank_of(q))));
    ranks.push_back(static_cast<std::uint64_t>(std::ceil(rank_of(q))));
  }
  const auto statistics = order_statistics(values, ranks);

  std::vector<double> results;
  for (const PrefixQuantile& q : wanted) {
    if (q.n_first == 0) {
      results.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const double rank = rank_of(q);
    const double low = measure(statistics.at(static_cast<std::uint64_t>(std::floor(rank))));
    const double high = measure(statistics.at(static_cast<std::uint64_t>(std::ceil(rank))));
    results.push_back(low + (rank - std::floor(rank)) * (high - low));
  }
  return results;
}

std::vector<double> quantiles(std::span<const double> values, std::span<const double> shares) {
  std::vector<PrefixQuantile> wanted;
  for (double share : shares) wanted.push_back({values.size(), share});
  return prefix_quantiles(values, wanted);
}

}  // namespace cmap
