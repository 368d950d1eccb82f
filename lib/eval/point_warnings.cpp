#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "cmap/core/parallel.hpp"
#include "cmap/core/sampled_indices.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "plausibility.hpp"

namespace cmap {
namespace {

constexpr std::size_t kSample = 2000;
constexpr double kManyRepeated = 0.01;
constexpr std::size_t kFewest = 20;  // points from which on shares and medians say something

/// Distance to the nearest point at another place, 0 where none is among the neighbors.
double nearest_elsewhere_m(const PointBlocks& points, std::size_t slot, std::span<const std::uint32_t> neighbors) {
  for (const std::uint32_t neighbor : neighbors) {
    if (neighbor == kNoNeighbor) break;
    const double distance_m = (points.offset(neighbor) - points.offset(slot)).cast<double>().norm();
    if (distance_m > 0.0) return distance_m;
  }
  return 0.0;
}

/// 64 bits that differ for different places, but for a chance of one in 10^5 among ten million points.
std::uint64_t place_key(const Eigen::Vector3f& p) {
  std::uint64_t key = 0;
  for (const float value : {p.x(), p.y(), p.z()}) {
    key ^= std::bit_cast<std::uint32_t>(value + 0.0F);  // -0 is 0
    key *= 0x9e3779b97f4a7c15ull;
    key ^= key >> 29;
    key *= 0xbf58476d1ce4e5b9ull;
    key ^= key >> 32;
  }
  return key;
}

std::uint64_t n_repeated(const PointBlocks& points) {
  Array<std::uint64_t> keys(points.size);
  parallel_chunks(points.size, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) keys[slot] = place_key(points.offset(slot));
  });
  std::ranges::sort(keys);
  return points.size - static_cast<std::uint64_t>(std::ranges::unique(keys).begin() - keys.begin());
}

/// The steps of a raster are where its points are: none is nearer to the next one, and none shares its place.
bool is_raster(const CoordinateStep& step, const SampledSpacing& spacing) {
  using enum CoordinateStep::Cause;
  return (step.cause == kDigits || step.cause == kGrid) && spacing.spacing_m > 0.99 * step.step_m &&
         spacing.spacing_m < 1.5 * step.step_m && spacing.repeated_share < kManyRepeated;
}

Warning step_warning(std::string_view which, const CoordinateStep& step, const EvaluationOptions& options) {
  const std::string steps = fmt::format("the {}'s {} comes in steps of {:.3g} m", which, "xyz"[step.axis], step.step_m);
  const std::string needed = fmt::format("coarser than a tenth of the smallest threshold, {:g} m",
                                         *std::ranges::min_element(options.thresholds_m));
  switch (step.cause) {
    case CoordinateStep::Cause::kFloat16:
    case CoordinateStep::Cause::kFloat32:
      return {"coarse_coordinates",
              fmt::format("{}, as {} has at {:.7g} m, {}: store the map in {}, or take an offset off it first", steps,
                          step.cause == CoordinateStep::Cause::kFloat16 ? "float16" : "float32", step.coordinate,
                          needed, step.cause == CoordinateStep::Cause::kFloat16 ? "float32" : "double precision")};
    case CoordinateStep::Cause::kGrid:
      return {"coarse_coordinates",
              fmt::format("{}, those of a raster or of the file's own scale, {}: no threshold below them says more",
                          steps, needed)};
    case CoordinateStep::Cause::kDigits:
      return {"coarse_coordinates",
              fmt::format("{}, as if rounded to few digits ({:.7g}), {}: store it with more digits", steps,
                          step.coordinate, needed)};
    case CoordinateStep::Cause::kOwnOffsets:
      break;
  }
  return {"precision_reduced",
          fmt::format(
              "{} here, as {:.7g} m is far from the map's origin for single precision, {}: compare parts of the map "
              "as files of their own, without far strays",
              steps, step.coordinate, needed)};
}

}  // namespace

double finest_step_needed_m(const EvaluationOptions& options) {
  return *std::ranges::min_element(options.thresholds_m) / 10.0;
}

SampledSpacing sampled_spacing(const Bvh& index) {
  constexpr std::size_t kNeighbors = 8;
  Array<std::uint32_t> slots;
  // Whole blocks, as neighbors are searched together.
  for (const std::size_t block : sampled_indices(index.points.blocks.size(), kSample / kBlockSize)) {
    for (std::size_t slot = block * kBlockSize; slot < std::min((block + 1) * kBlockSize, index.points.size); ++slot) {
      slots.push_back(static_cast<std::uint32_t>(slot));
    }
  }
  const Array<std::uint32_t> neighbors = find_k_nearest(index, chosen_points(index.points, slots), kNeighbors);
  std::vector<double> distances_m;
  std::size_t repeated = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::span<const std::uint32_t> found(neighbors.data() + i * kNeighbors, kNeighbors);
    const double distance_m = nearest_elsewhere_m(index.points, slots[i], found);
    if (distance_m > 0.0) distances_m.push_back(distance_m);
    if (found[1] != kNoNeighbor && index.points.offset(found[1]) == index.points.offset(slots[i])) ++repeated;
  }
  SampledSpacing spacing{std::numeric_limits<double>::quiet_NaN(),
                         static_cast<double>(repeated) / static_cast<double>(slots.size())};
  if (distances_m.size() < kFewest) return spacing;
  spacing.spacing_m = upper_median(distances_m);
  return spacing;
}

void warn_about_points(std::string_view which, const PointBlocks& points, const SampledSpacing& spacing,
                       const std::optional<CoordinateStep>& step, const EvaluationOptions& options,
                       std::vector<Warning>& warnings) {
  const bool coarse = step && !is_raster(*step, spacing);
  if (coarse) warnings.push_back(step_warning(which, *step, options));
  // Rounded coordinates meet in the same places: said already.
  if (points.size < kFewest || spacing.repeated_share < kManyRepeated ||
      (coarse && 2.0 * step->step_m > spacing.spacing_m))
    return;
  const std::uint64_t n = n_repeated(points);
  warnings.push_back(
      {"repeated_points",
       fmt::format(
           "{} of the {}'s {} points ({:.3g} %) are copies: they stand at the same place as another one, and count "
           "in every mean, in color consistency and towards the points that AWD and MME need",
           n, which, points.size, 100.0 * static_cast<double>(n) / static_cast<double>(points.size))});
}

void warn_about_spacing(const SampledSpacing& reference, const NearestField& nearest_in_reference,
                        std::span<const Record> fitness, std::vector<Warning>& warnings) {
  // A place anywhere on the surface is 0.4 (grid) to 1.0 (random points) spacings from the next point of the reference.
  constexpr double kOnItsPoints = 0.3, kElsewhere = 2.0;
  std::vector<double> sq_dist;
  for (const std::size_t slot : sampled_indices(nearest_in_reference.sq_dist.size(), kSample)) {
    sq_dist.push_back(nearest_in_reference.sq_dist[slot]);
  }
  const double spacings = std::sqrt(upper_median(sq_dist)) / reference.spacing_m;
  if (!(spacings > kOnItsPoints && spacings < kElsewhere)) return;
  std::vector<double> missed_m;
  for (const Record& level : fitness) {
    const bool below = *level.threshold_m < reference.spacing_m;
    if (below && *level.value < 0.5) missed_m.push_back(*level.threshold_m);
  }
  // The smallest of many thresholds is below nearly every spacing.
  const std::size_t n_to_say = fitness.size() > 2 ? 2 : 1;
  if (missed_m.size() < n_to_say) return;
  warnings.push_back(
      {"sparse_reference",
       fmt::format(
           "the reference's points have a spacing of {:.3g} m, above the threshold{} {} m, which even an estimate "
           "that lies on the surface between them mostly misses: take larger ones, or a denser reference",
           reference.spacing_m, missed_m.size() == 1 ? "" : "s", fmt::join(missed_m, ", "))});
}

}  // namespace cmap
