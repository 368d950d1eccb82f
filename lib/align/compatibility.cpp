#include "compatibility.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

using Points = std::span<const Eigen::Vector3d>;

constexpr std::size_t kSeeds = 200;   ///< matches that sets are grown from
constexpr std::size_t kSetSize = 30;  ///< the matches of a set that the first fit uses
constexpr double kFreeScale = 0.05;   ///< relative uncertainty of a voted scale
constexpr int kRefits = 4;

/// One bit for each pair of matches.
class PairBits {
 public:
  explicit PairBits(std::size_t n) : n_(n), words_((n + 63) / 64), bits_(n * words_, 0) {}
  void set(std::size_t i, std::size_t j) { bits_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64); }
  bool operator()(std::size_t i, std::size_t j) const { return (bits_[i * words_ + j / 64] >> (j % 64) & 1) != 0; }
  std::size_t count(std::size_t i) const { return in_common(i, i); }
  std::size_t in_common(std::size_t i, std::size_t j) const {
    std::size_t n = 0;
    for (std::size_t w = 0; w < words_; ++w) {
      n += static_cast<std::size_t>(std::popcount(bits_[i * words_ + w] & bits_[j * words_ + w]));
    }
    return n;
  }
  std::size_t size() const { return n_; }

 private:
  std::size_t n_, words_;
  std::vector<std::uint64_t> bits_;
};

PairBits compatible_pairs(Points p, Points q, double scale, bool scale_is_free, double tolerance_m) {
  PairBits pairs(p.size());
  parallel_chunks(p.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < p.size(); ++j) {
        const double in_source = scale * (p[i] - p[j]).norm();
        const double in_target = (q[i] - q[j]).norm();
        const double slack = tolerance_m + (scale_is_free ? kFreeScale * in_source : 0.0);
        // Neighbors agree by chance.
        const bool apart = in_target > 2.0 * tolerance_m && in_source > 2.0 * tolerance_m;
        if (apart && std::abs(in_source - in_target) <= slack) pairs.set(i, j);
      }
    }
  });
  return pairs;
}

/// Indices by decreasing value, ties by index; the first n.
std::vector<std::size_t> largest(const std::vector<std::size_t>& values, std::size_t n) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  order.resize(std::min(n, order.size()));
  return order;
}

Similarity fit(Points p, Points q, const std::vector<std::size_t>& chosen, double scale, bool scale_is_free) {
  return fit_similarity(pair_moments(chosen.size(),
                                     [&](std::size_t k) {
                                       return WeightedPair{p[chosen[k]], q[chosen[k]], 1.0};
                                     }),
                        {scale_is_free, scale, 0.0});
}

std::vector<std::size_t> inliers(Points p, Points q, const Similarity& T, double tolerance_m) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if ((T * p[i] - q[i]).squaredNorm() <= tolerance_m * tolerance_m) found.push_back(i);
  }
  return found;
}

/// The set around one seed, fitted, then refitted to all matches that agree.
Hypothesis grow(Points p, Points q, const PairBits& pairs, std::size_t seed, double scale, bool scale_is_free,
                double tolerance_m) {
  std::vector<std::size_t> support(pairs.size(), 0);
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    if (pairs(seed, j)) support[j] = pairs.in_common(seed, j) + 1;
  }
  std::vector<std::size_t> chosen = largest(support, kSetSize);
  std::erase_if(chosen, [&](std::size_t j) { return support[j] == 0; });
  chosen.push_back(seed);
  Hypothesis best;
  try {
    for (int i = 0; i < kRefits; ++i) {
      const Similarity T = fit(p, q, chosen, scale, scale_is_free);
      chosen = inliers(p, q, T, tolerance_m);
      if (chosen.size() > best.n_inliers) best = {T, chosen.size()};
    }
  } catch (const UnsupportedError&) {
    // Too few, or on a line: no hypothesis of its own.
  }
  return best;
}

bool are_alike(const Similarity& a, const Similarity& b, Points p, double tolerance_m) {
  for (const std::size_t i : {std::size_t{0}, p.size() / 3, 2 * p.size() / 3, p.size() - 1}) {
    if ((a * p[i] - b * p[i]).norm() > 2.0 * tolerance_m) return false;
  }
  return true;
}

}  // namespace

std::vector<Hypothesis> compatible_hypotheses(Points p, Points q, double scale, bool scale_is_free, double tolerance_m,
                                              std::size_t n_best) {
  if (p.size() < 3) return {};
  const PairBits pairs = compatible_pairs(p, q, scale, scale_is_free, tolerance_m);
  std::vector<std::size_t> degree(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) degree[i] = pairs.count(i);
  const std::vector<std::size_t> seeds = largest(degree, kSeeds);
  std::vector<Hypothesis> all(seeds.size());
  parallel_chunks(seeds.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) all[s] = grow(p, q, pairs, seeds[s], scale, scale_is_free, tolerance_m);
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.n_inliers > b.n_inliers; });
  std::vector<Hypothesis> best;
  for (const Hypothesis& h : all) {
    if (h.n_inliers < 3 || best.size() == n_best) break;
    const auto alike = [&](const Hypothesis& other) { return are_alike(h.T, other.T, p, tolerance_m); };
    if (std::none_of(best.begin(), best.end(), alike)) best.push_back(h);
  }
  return best;
}

std::vector<double> voted_scales(Points p, Points q, double shortest_m, std::size_t n_best) {
  constexpr double kBin = 0.02, kReach = 0.7;  // of log scale
  constexpr auto kBins = static_cast<std::size_t>(2.0 * kReach / kBin) + 1;
  std::vector<double> votes(kBins + 2, 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double in_source = (p[i] - p[j]).norm(), in_target = (q[i] - q[j]).norm();
      if (in_source < shortest_m || in_target < shortest_m) continue;
      const double place = (std::log(in_target / in_source) + kReach) / kBin;
      if (place < 0.0 || place >= static_cast<double>(kBins)) continue;
      const double share = place - std::floor(place);
      const auto bin = static_cast<std::size_t>(place);
      votes[bin] += 1.0 - share;
      votes[bin + 1] += share;
    }
  }
  std::vector<double> scales;
  while (scales.size() < n_best) {
    const auto most = std::max_element(votes.begin(), votes.end());
    if (*most <= 0.0) break;
    const auto bin = most - votes.begin();
    scales.push_back(std::exp(static_cast<double>(bin) * kBin - kReach));
    for (auto near = std::max<std::ptrdiff_t>(0, bin - 2);
         near < std::min<std::ptrdiff_t>(bin + 3, static_cast<std::ptrdiff_t>(votes.size())); ++near) {
      votes[static_cast<std::size_t>(near)] = 0.0;
    }
  }
  return scales;
}

}  // namespace cmap
