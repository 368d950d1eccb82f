#include <algorithm>
#include <memory>

#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/visibility.hpp"
#include "measurement.hpp"
#include "space_parts.hpp"

namespace cmap {
namespace {

constexpr double kColumn_m = 1.0;
constexpr std::uint32_t kObserved = 0, kUnobserved = 1;

/// Where a map has points: vertical columns of a meter with any, grown by one to all sides.
class ObservedColumns {
 public:
  explicit ObservedColumns(const IndexedMap& map)
      : frame_(grown(map.index.bounds()), kColumn_m), box_(map.index.bounds()) {
    VoxelMap<bool> occupied;
    for (std::size_t slot = 0; slot < map.size(); ++slot) occupied[column(map.index.points.world(slot))] = true;
    for (const auto& [key, unused] : occupied.entries()) {
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) observed_[{key.x + dx, key.y + dy, 0}] = true;
      }
    }
  }

  bool contains(const Eigen::Vector3d& world) const {
    const bool inside = (world.head<2>().array() >= box_.min.head<2>().array() - 2.0 * kColumn_m).all() &&
                        (world.head<2>().array() <= box_.max.head<2>().array() + 2.0 * kColumn_m).all();
    return inside && observed_.find(column(world)) != nullptr;
  }

 private:
  static Box3d grown(Box3d box) {
    box.min.array() -= 3.0 * kColumn_m;
    box.max.array() += 3.0 * kColumn_m;
    return box;
  }
  VoxelKey column(const Eigen::Vector3d& world) const {
    const VoxelKey key = frame_.key(world);
    return {key.x, key.y, 0};
  }

  VoxelFrame frame_;
  Box3d box_;
  VoxelMap<bool> observed_;
};

template <class Seen>
PartOf part_by(std::shared_ptr<const Seen> seen) {
  return [seen](const Eigen::Vector3d& world) { return seen->contains(world) ? kObserved : kUnobserved; };
}

/// How many of a side's points are in the part that was not observed.
UnobservedPoints unobserved_points(const Array<std::uint32_t>& parts) {
  const auto n = std::ranges::count(parts, kUnobserved);
  return {static_cast<std::uint64_t>(n), static_cast<double>(n) / static_cast<double>(parts.size())};
}

/// The parts of points and voxels, and what is said of how they were found.
SpaceParts observed_parts(const MapPair& pair, const EvaluationOptions& options,
                          std::span<const Eigen::Vector3d> sensor_positions, ObservedPart& about) {
  const auto of_reference = std::make_shared<const ObservedColumns>(pair.reference);
  if (options.observed == Observed::kAuto) {
    return space_parts(pair, part_by(of_reference), part_by(std::make_shared<const ObservedColumns>(pair.estimate)));
  }
  const auto seen = std::make_shared<const VisibleSurfaces>(pair.reference.index, sensor_positions, options.visibility);
  about.n_positions = seen->n_positions();
  return space_parts(pair, part_by(of_reference), part_by(seen));
}

}  // namespace

ObservedPart observed_part(const MetricInputs& inputs, std::span<const Metric* const> metrics,
                           const EvaluationOptions& options, std::span<const Eigen::Vector3d> sensor_positions) {
  ObservedPart observed{.method = options.observed, .column_m = kColumn_m};
  SpaceParts parts = observed_parts(*inputs.pair, options, sensor_positions, observed);
  parts.n = 2;
  for (const Side side : inputs.sides()) observed.left_out.of(side) = unobserved_points(parts.of_slots.of(side));
  const MetricSums sums = sum_metrics(metrics, inputs, std::move(parts));
  constexpr double kOnlyObserved[] = {1.0, 0.0};
  for (const SummedValue& value : MetricFormulas(sums, inputs.settings).values(kOnlyObserved)) {
    if (std::ranges::count(metrics, metric_of(value.id)) > 0) observed.values.push_back(value);
  }
  return observed;
}

}  // namespace cmap
