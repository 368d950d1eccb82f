#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plausibility.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestPoints = 20;  // of fewer, one is no exception
constexpr std::size_t kMostStrays = 64;
constexpr double kRounding_m = 1e-4;  // distances up to here are how maps were stored, and no point strays by them

/// The farthest points of one direction, farthest first, and what is left without them.
struct Strays {
  std::vector<std::size_t> slots;
  double rmse_without_m = 0.0;
  double mean_without_m = 0.0;
};

double largest_of(std::span<const double> values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size())).maxCoeff();
}

std::size_t most_strays(std::size_t n) {
  return n < kFewestPoints ? 0 : std::clamp<std::size_t>(n / 100, 1, kMostStrays);
}

/// Whether that much of the squared distances or of the distances makes RMSE or the mean at least double.
bool decides(double sq_share, double share) { return sq_share >= 0.75 || share >= 0.5; }

std::vector<std::size_t> farthest_slots(std::span<const double> sq_dist, std::size_t n_wanted) {
  std::vector<std::size_t> farthest;
  for (std::size_t slot = 0; slot < sq_dist.size(); ++slot) {
    if (farthest.size() == n_wanted && sq_dist[slot] <= sq_dist[farthest.back()]) continue;
    const auto place = std::ranges::find_if(farthest, [&](std::size_t f) { return sq_dist[f] < sq_dist[slot]; });
    farthest.insert(place, slot);
    if (farthest.size() > n_wanted) farthest.pop_back();
  }
  return farthest;
}

/// Sums of distances; points are added to those of the rest, not taken off the whole, of which nothing might be left
/// but rounding.
struct Sums {
  double sq = 0.0;
  double plain = 0.0;

  Sums with(double sq_dist) const { return {sq + sq_dist, plain + std::sqrt(sq_dist)}; }
  bool decided_by(const Sums& rest) const { return decides(1.0 - rest.sq / sq, 1.0 - rest.plain / plain); }
};

Sums sums_without(std::span<const double> sq_dist, const std::vector<std::size_t>& slots) {
  Sums sums;
  for (std::size_t slot = 0; slot < sq_dist.size(); ++slot) {
    if (std::ranges::find(slots, slot) == slots.end()) sums = sums.with(sq_dist[slot]);
  }
  return sums;
}

/// The points that decide RMSE or the mean distance, and those that decide what is left without them. Where even the
/// largest distance taken several times would not, the distances are not looked at.
Strays deciding_strays(std::span<const double> sq_dist, const MeanDistances& means) {
  const std::size_t most = most_strays(sq_dist.size());
  const auto n = means.n, n_most = static_cast<double>(most);
  const double max_m = std::sqrt(largest_of(sq_dist));
  if (most == 0 || max_m < kRounding_m ||
      !decides(n_most * max_m * max_m / (n * means.mean_sq_m2), n_most * max_m / (n * means.mean_m))) {
    return {};
  }
  const std::vector<std::size_t> farthest = farthest_slots(sq_dist, most);
  std::vector<Sums> without{sums_without(sq_dist, farthest)};  // the k farthest, k from most to 0
  for (auto slot = farthest.rbegin(); slot != farthest.rend(); ++slot) {
    without.push_back(without.back().with(sq_dist[*slot]));
  }
  std::ranges::reverse(without);
  std::size_t n_strays = 0;
  for (std::size_t k = 1; k <= most; ++k) {
    if (without[n_strays].decided_by(without[k])) n_strays = k;
  }
  if (n_strays == 0) return {};
  const double n_left = n - static_cast<double>(n_strays);
  return {{farthest.begin(), farthest.begin() + static_cast<std::ptrdiff_t>(n_strays)},
          std::sqrt(without[n_strays].sq / n_left),
          without[n_strays].plain / n_left};
}

std::string described(const Strays& strays, const NearestPairs& pairs, const char* from, const char* to) {
  const PointBlocks& points = pairs.from.index.points;
  const std::size_t slot = strays.slots.front();
  const Eigen::Vector3d x = points.world(slot);
  const std::string which =
      fmt::format("point {} of the {}'s {}, at ({:.10g}, {:.10g}, {:.10g}), lies {:.4g} m from the {}",
                  points.original_index[slot] + 1, from, points.size, x.x(), x.y(), x.z(), pairs.distance_m(slot), to);
  if (strays.slots.size() == 1) return "one stray point decides the distances: " + which + "; without it";
  return fmt::format("{} stray points decide the distances: the farthest, {}; without them", strays.slots.size(),
                     which);
}

void warn(const NearestPairs& pairs, const MeanDistances& means, bool gives_rmse, std::vector<Warning>& warnings) {
  const Strays strays = deciding_strays(pairs.nearest.sq_dist, means);
  if (strays.slots.empty()) return;
  const std::string change =
      gives_rmse
          ? fmt::format("RMSE is {:.4g} m, not {:.4g} m", strays.rmse_without_m, std::sqrt(means.mean_sq_m2))
          : fmt::format("the mean distance from reference to estimate, which Chamfer adds, is {:.4g} m, not {:.4g} m",
                        strays.mean_without_m, means.mean_m);
  warnings.push_back({"stray_points", described(strays, pairs, gives_rmse ? "estimate" : "reference",
                                                gives_rmse ? "reference" : "estimate") +
                                          " " + change});
}

}  // namespace

void warn_about_strays(const MapPair& pair, const MeanDistances& estimate_to_reference,
                       const MeanDistances& reference_to_estimate, std::vector<Warning>& warnings) {
  warn(pair.estimate_to_reference(), estimate_to_reference, true, warnings);
  warn(pair.reference_to_estimate(), reference_to_estimate, false, warnings);
}

}  // namespace cmap
