#include "distribution.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cmap/core/parallel.hpp"
#include "cmap/core/round_number.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/spatial/radix_sort.hpp"

namespace cmap {
namespace {

constexpr std::size_t kBins = 500;

constexpr std::uint32_t kSign = 0x80000000;

/// A whole number for each float, in the order of the floats.
std::uint32_t ordered_code(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}
float of_ordered_code(std::uint32_t code) { return std::bit_cast<float>((code & kSign) != 0 ? code & ~kSign : ~code); }

struct Counts {
  std::array<std::uint64_t, kBins + 1> n{};  ///< the last one: beyond
  Counts& operator+=(const Counts& other) {
    std::ranges::transform(n, other.n, n.begin(), std::plus<>());
    return *this;
  }
};

DirectedDistribution binned(const Array<double>& errors, double bin_width, double p95) {
  const auto total = ordered_sum<Counts>(errors.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    Counts part;
    for (std::size_t i = begin; i < end; ++i) {
      const double bin = std::max(std::ceil(errors[i] / bin_width) - 1.0, 0.0);
      ++part.n[static_cast<std::size_t>(std::min(bin, static_cast<double>(kBins)))];
    }
    return part;
  });
  return {{total.n.begin(), total.n.end() - 1}, total.n.back(), p95};
}

Array<double> errors_of(const NearestPairs& pairs, PairError error) {
  Array<double> errors(pairs.size());
  parallel_chunks(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) errors[slot] = (pairs.*error)(slot);
  });
  std::erase_if(errors, [](double v) { return std::isnan(v); });  // pairs without both colors
  return errors;
}

}  // namespace

Distribution distribution_of(const MapPair& pair, PairError error) {
  constexpr std::array kShares{0.95, 0.99};
  const Array<double> estimate = errors_of(pair.estimate_to_reference(), error);
  const Array<double> reference = errors_of(pair.reference_to_estimate(), error);
  const std::vector<double> of_estimate = quantiles(estimate, kShares);
  const std::vector<double> of_reference = quantiles(reference, kShares);
  const double bin_width = round_number_above(std::max(of_estimate[1], of_reference[1])) / static_cast<double>(kBins);
  return {bin_width, binned(estimate, bin_width, of_estimate[0]), binned(reference, bin_width, of_reference[0]),
          ranked(estimate)};
}

RankedValues ranked(const Array<double>& values) {
  Array<std::uint64_t> codes(values.size()), scratch;
  parallel_chunks(values.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) codes[i] = ordered_code(static_cast<float>(values[i]));
  });
  radix_sort(codes, scratch, 0, 32);
  RankedValues table{codes.size(), {}};
  const std::size_t n = std::min(codes.size(), kMostRanked);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t code = codes[n == 1 ? 0 : i * (codes.size() - 1) / (n - 1)];
    table.values.push_back(static_cast<double>(of_ordered_code(static_cast<std::uint32_t>(code))));
  }
  return table;
}

}  // namespace cmap
