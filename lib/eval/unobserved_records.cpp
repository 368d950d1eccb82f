#include "cmap/spatial/visibility.hpp"
#include "cmap/spatial/voxel_map.hpp"
#include "eval/fairness_records.hpp"
#include "eval/gathered_sums.hpp"
#include "eval/json_number.hpp"
#include "eval/summed_records.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

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
PartOf part_by(const Seen& seen) {
  return [&seen](const Eigen::Vector3d& world) { return seen.contains(world) ? kObserved : kUnobserved; };
}

/// The sums of both parts: estimated points by where the reference is, reference points by what the estimate's sensor
/// saw where it is known, else by where the estimate is.
MetricSums sums_of_parts(const Findings& f, const LocalColorRecall* recall, Json& about) {
  const ObservedColumns of_reference(f.pair.reference);
  if (f.options.observed == Observed::kAuto) {
    const ObservedColumns of_estimate(f.pair.estimate);
    about = {{"method", "auto"}, {"column_m", kColumn_m}};
    return gathered_sums(f, recall, part_by(of_reference), part_by(of_estimate));
  }
  const VisibleSurfaces seen(f.pair.reference.index, f.sensor_positions, f.options.visibility);
  about = {{"method", "sensor"},
           {"column_m", kColumn_m},
           {"voxel_m", f.options.visibility.voxel_m},
           {"range_m", f.options.visibility.range_m},
           {"n_positions", seen.n_positions()}};
  return gathered_sums(f, recall, part_by(of_reference), part_by(seen));
}

Json counts(double n_observed, double n_unobserved) {
  return {{"n_unobserved", static_cast<std::uint64_t>(n_unobserved)},
          {"share_unobserved", n_unobserved / (n_observed + n_unobserved)}};
}

}  // namespace

Json unobserved_records(const Findings& f, const LocalColorRecall* recall) {
  if (f.options.observed == Observed::kNone) return nullptr;
  Json records;
  MetricSums sums = sums_of_parts(f, recall, records);
  sums.n_parts = 2;
  for (auto& [name, parts] : sums.columns) parts.resize(2);
  constexpr double kOnlyObserved[] = {1.0, 0.0}, kOnlyUnobserved[] = {0.0, 1.0};
  const MetricTotals observed = totals_of(sums, kOnlyObserved), unobserved = totals_of(sums, kOnlyUnobserved);
  Json metrics = Json::object();
  for (const SummedValue& v : values_of(observed)) {
    if (f.selection.contains(v.id)) add_entry(metrics, v.id, v.threshold_m, {{"value", json_number(v.value)}});
  }
  records["estimate"] = counts(observed.at("estimate.n"), unobserved.at("estimate.n"));
  records["reference"] = counts(observed.at("reference.n"), unobserved.at("reference.n"));
  records["metrics"] = metrics;
  return records;
}

}  // namespace cmap
