#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/plausibility.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestPoints = 20;  // of fewer, one is no exception
constexpr std::size_t kMostStrays = 3;

/// The farthest points of one direction, farthest first, and what is left without them.
struct Strays {
  std::vector<std::size_t> slots;
  double rmse_without_m = 0.0;
  double mean_without_m = 0.0;
};

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

/// The points that decide RMSE or the mean distance, and those that decide what is left without them. Where even the
/// largest distance taken several times would not, the distances are not looked at.
Strays deciding_strays(std::span<const double> sq_dist, const DistanceStats& stats) {
  Strays strays;
  const std::size_t most = most_strays(sq_dist.size());
  const auto n = static_cast<double>(stats.n), n_most = static_cast<double>(most);
  double sq_left = n * stats.mean_sq_m2, left = n * stats.mean_m;
  if (most == 0 || !decides(n_most * stats.max_m * stats.max_m / sq_left, n_most * stats.max_m / left)) return strays;
  std::vector<std::size_t> taken;
  double sq_taken = 0.0, sum_taken = 0.0;  // since the last ones that decided
  for (const std::size_t slot : farthest_slots(sq_dist, most)) {
    taken.push_back(slot);
    sq_taken += sq_dist[slot];
    sum_taken += std::sqrt(sq_dist[slot]);
    if (!decides(sq_taken / sq_left, sum_taken / left)) continue;
    sq_left = std::max(0.0, sq_left - sq_taken);
    left = std::max(0.0, left - sum_taken);
    sq_taken = sum_taken = 0.0;
    const double n_left = n - static_cast<double>(taken.size());
    strays = {taken, std::sqrt(sq_left / n_left), left / n_left};
  }
  return strays;
}

std::string described(const Strays& strays, const NearestPairs& pairs, const char* from, const char* to) {
  const PointBlocks& points = pairs.from.index.points;
  const std::size_t slot = strays.slots.front();
  const Eigen::Vector3d x = points.world(slot);
  const std::string which =
      fmt::format("point {} of the {}'s {}, at ({:.10g}, {:.10g}, {:.10g}), lies {:.4g} m from the {}",
                  points.original_index[slot] + 1, from, points.size, x.x(), x.y(), x.z(), pairs.distance_m(slot), to);
  if (strays.slots.size() == 1) return "one stray point decides the distances: " + which + "; without it";
  return fmt::format("{} stray points decide the distances: the farthest, {}; without them", strays.slots.size(), which);
}

void warn(const NearestPairs& pairs, const DistanceStats& stats, bool gives_rmse, std::vector<Warning>& warnings) {
  const Strays strays = deciding_strays(pairs.nearest.sq_dist, stats);
  if (strays.slots.empty()) return;
  const std::string change =
      gives_rmse ? fmt::format("RMSE is {:.4g} m, not {:.4g} m", strays.rmse_without_m, std::sqrt(stats.mean_sq_m2))
                 : fmt::format("the mean distance from reference to estimate, which Chamfer adds, is {:.4g} m, not {:.4g} m",
                               strays.mean_without_m, stats.mean_m);
  warnings.push_back({"stray_points", described(strays, pairs, gives_rmse ? "estimate" : "reference",
                                                gives_rmse ? "reference" : "estimate") +
                                          " " + change});
}

}  // namespace

void warn_about_strays(const MapPair& pair, const DistanceStats& estimate_to_reference,
                       const DistanceStats& reference_to_estimate, std::vector<Warning>& warnings) {
  warn(pair.estimate_to_reference(), estimate_to_reference, true, warnings);
  warn(pair.reference_to_estimate(), reference_to_estimate, false, warnings);
}

}  // namespace cmap
