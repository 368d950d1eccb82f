#include "trajectory/robust_centers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestPairs = 8;
constexpr std::size_t kTriples = 300;   // of which 6 in 10 pairs that fit leave none of one in 1e31
constexpr double kTimesMedian = 15.0;   // published estimates reach 11 times, with no pose that jumps
constexpr double kShareOfSize = 0.01;   // what jumps by less moves the fit by less
constexpr double kShareOfSteps = 0.01;  // of the size; where the path has moved as far, it is looked at again
constexpr std::size_t kMostIterations = 20;

double median(std::vector<double> values) { return upper_median(values); }

/// Median distance of the target's positions from their median: strays do not count.
double size_of_path_m(std::span<const PosePair> pairs) {
  Eigen::Vector3d center;
  std::vector<double> values(pairs.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(pairs, values.begin(), [&](const PosePair& pair) { return pair.target.position[axis]; });
    center[axis] = median(values);
  }
  std::ranges::transform(pairs, values.begin(),
                         [&](const PosePair& pair) { return (pair.target.position - center).norm(); });
  return median(values);
}

/// Pairs along the path whose targets are a step apart: where it stays, one of many.
std::vector<PosePair> along_the_path(std::span<const PosePair> pairs, double step_m) {
  std::vector<PosePair> kept;
  for (const PosePair& pair : pairs) {
    const bool moved = kept.empty() || (pair.target.position - kept.back().target.position).norm() >= step_m;
    if (moved) kept.push_back(pair);
  }
  return kept;
}

std::optional<Similarity> fit_of_triple(std::span<const PosePair> pairs, const std::array<std::size_t, 3>& triple,
                                        const ScaleModel& model) {
  const std::array<PosePair, 3> chosen{pairs[triple[0]], pairs[triple[1]], pairs[triple[2]]};
  try {
    return fit_similarity(center_moments(chosen), model);
  } catch (const UnsupportedError&) {
    return std::nullopt;  // in a line
  }
}

/// The fit of a triple with the least median distance.
Similarity least_median(std::span<const PosePair> path, const Similarity& start, const ScaleModel& model) {
  Similarity best = start;
  double least = median(center_distances(path, start));
  std::mt19937_64 random(1);
  for (std::size_t i = 0; i < kTriples; ++i) {
    const std::array<std::size_t, 3> triple{random() % path.size(), random() % path.size(), random() % path.size()};
    const auto T = fit_of_triple(path, triple, model);
    if (!T) continue;
    const double found = median(center_distances(path, *T));
    if (found < least) least = found, best = *T;
  }
  return best;
}

std::vector<std::uint8_t> within(std::span<const double> distances, double gate) {
  std::vector<std::uint8_t> mask(distances.size());
  std::ranges::transform(distances, mask.begin(), [&](double d) { return d <= gate ? 1 : 0; });
  return mask;
}

std::size_t n_marked(std::span<const std::uint8_t> mask) {
  return static_cast<std::size_t>(std::ranges::count(mask, std::uint8_t{1}));
}

/// From a start, leaves out what does not fit and fits the rest until it stays the same.
RobustCenters refine(std::span<const PosePair> pairs, std::span<const PosePair> path, Similarity T,
                     const ScaleModel& model, double size_m) {
  RobustCenters result{T, {}, 0};
  for (std::size_t i = 0; i < kMostIterations; ++i) {
    const double gate = std::max(kTimesMedian * median(center_distances(path, result.T)), kShareOfSize * size_m);
    std::vector<std::uint8_t> fits = within(center_distances(pairs, result.T), gate);
    if (fits == result.fits) break;
    result.T = fit_similarity(center_moments(pairs, fits), model);
    result.fits = std::move(fits);
  }
  result.n_misfits = pairs.size() - n_marked(result.fits);
  return result;
}

}  // namespace

PairMoments center_moments(std::span<const PosePair> pairs, std::span<const std::uint8_t> mask) {
  return pair_moments(pairs.size(), [&](std::size_t i) {
    const double weight = mask.empty() || mask[i] != 0 ? 1.0 : 0.0;
    return WeightedPair{pairs[i].source.position, pairs[i].target.position, weight};
  });
}

std::vector<double> center_distances(std::span<const PosePair> pairs, const Similarity& T) {
  std::vector<double> distances(pairs.size());
  std::ranges::transform(pairs, distances.begin(), [&](const PosePair& pair) {
    return (T * pair.source.position - pair.target.position).norm();
  });
  return distances;
}

double center_rmse_m(std::span<const PosePair> pairs, const Similarity& T) {
  double sum_sq = 0.0;
  for (const PosePair& pair : pairs) sum_sq += (T * pair.source.position - pair.target.position).squaredNorm();
  return std::sqrt(sum_sq / static_cast<double>(pairs.size()));
}

RobustCenters fit_most_centers(std::span<const PosePair> pairs, const ScaleModel& model) {
  const RobustCenters plain{fit_similarity(center_moments(pairs), model), std::vector<std::uint8_t>(pairs.size(), 1),
                            0};
  if (pairs.size() < kFewestPairs) return plain;
  const double size_m = size_of_path_m(pairs);
  const std::vector<PosePair> path = along_the_path(pairs, kShareOfSteps * size_m);
  if (path.size() < kFewestPairs) return plain;
  try {
    RobustCenters found = refine(pairs, path, least_median(path, plain.T, model), model, size_m);
    return 2 * found.n_misfits < pairs.size() && found.n_misfits > 0 ? found : plain;
  } catch (const UnsupportedError&) {
    return plain;  // what would be left has no shape
  }
}

}  // namespace cmap
