#include "eval/gathered_sums.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/core/color.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "cmap/metrics/color_distance.hpp"
#include "cmap/metrics/mean_map_entropy.hpp"

namespace cmap {
namespace {

/// Adds to columns that grow with the parts.
class Column {
 public:
  Column(MetricSums& sums, const std::string& name) : parts_(&sums.column(name)) {}
  void add(std::uint32_t part, double value) {
    if (part >= parts_->size()) parts_->resize(part + 1);
    (*parts_)[part] += value;
  }

 private:
  std::vector<double>* parts_;
};

/// The part of every point of a map.
Array<std::uint32_t> parts_of(const IndexedMap& map, const PartOf& part_of) {
  Array<std::uint32_t> parts(map.size());
  for (std::size_t slot = 0; slot < map.size(); ++slot) parts[slot] = part_of(map.index.points.world(slot));
  return parts;
}

/// One map's points and their nearest of the other.
struct Direction {
  std::string prefix;  ///< "estimate."
  NearestPairs pairs;
  Array<std::uint32_t> parts;
};

template <class Add>
void for_each_slot(const Direction& d, Add&& add) {
  for (std::size_t slot = 0; slot < d.pairs.size(); ++slot) add(slot, d.parts[slot]);
}

void add_distances(MetricSums& sums, const Direction& d, const EvaluationOptions& options) {
  Column n(sums, d.prefix + "n"), distance(sums, d.prefix + "distance"), square(sums, d.prefix + "sq_distance");
  Column overlapping(sums, d.prefix + "overlapping");
  std::vector<Column> n_within, square_within;
  for (double t : options.thresholds_m) {
    n_within.emplace_back(sums, fmt::format("{}n<={}", d.prefix, t));
    square_within.emplace_back(sums, fmt::format("{}sq_distance<={}", d.prefix, t));
  }
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    const double v = d.pairs.distance_m(slot), sq = d.pairs.nearest.sq_dist[slot];
    n.add(part, 1.0);
    distance.add(part, v);
    square.add(part, sq);
    overlapping.add(part, d.pairs.is_within(slot, options.overlap_distance_m) ? 1.0 : 0.0);
    for (std::size_t t = 0; t < options.thresholds_m.size(); ++t) {
      const bool within = d.pairs.is_within(slot, options.thresholds_m[t]);
      n_within[t].add(part, within ? 1.0 : 0.0);
      square_within[t].add(part, within ? sq : 0.0);
    }
  });
}

void add_color_distances(MetricSums& sums, const Direction& d, const EvaluationOptions& options,
                         const Eigen::Vector3d& from_gain, const Eigen::Vector3d& to_gain, const std::string& name) {
  Column n(sums, d.prefix + "color_n"), distance(sums, d.prefix + name);
  const double farthest_m = options.color_max_distance_m.value_or(INFINITY);
  const bool counts = name == "color_distance";
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    if (!d.pairs.is_within(slot, farthest_m) || !d.pairs.has_colors(slot)) return;
    distance.add(part, d.pairs.color_difference(slot, from_gain, to_gain).norm() / 255.0);
    if (counts) n.add(part, 1.0);
  });
}

void add_delta_e(MetricSums& sums, const Direction& d, double radius_m) {
  Column n(sums, d.prefix + "delta_e_n"), sum(sums, d.prefix + "delta_e");
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    if (!d.pairs.is_within(slot, radius_m) || !d.pairs.has_colors(slot)) return;
    sum.add(part, delta_e(d.pairs, slot));
    n.add(part, 1.0);
  });
}

void add_luma(MetricSums& sums, const Direction& d) {
  Column square(sums, d.prefix + "sq_luma"), n(sums, d.prefix + "luma_n");
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    if (!d.pairs.has_colors(slot)) return;
    n.add(part, 1.0);
    const double y = rgb_to_ycbcr709((d.pairs.from_color(slot) - d.pairs.to_color(slot)) / 255.0).x();
    square.add(part, y * y);
  });
}

void add_colors(MetricSums& sums, const Findings& f, const Direction& estimate, const Direction& reference) {
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  for (const Direction* d : {&estimate, &reference}) {
    add_color_distances(sums, *d, f.options, one, one, "color_distance");
    if (f.selection.contains("delta_e")) add_delta_e(sums, *d, f.options.lcr_radius_m);
    if (f.selection.contains("color_psnr")) add_luma(sums, *d);
  }
  if (f.selection.contains("color_distance_exposure_free")) {
    const Eigen::Vector3d gain = exposure_gains(f.pair, f.options.lcr_radius_m).gain;
    add_color_distances(sums, estimate, f.options, gain, one, "exposure_free");
    add_color_distances(sums, reference, f.options, one, gain, "exposure_free");
  }
}

void add_recall(MetricSums& sums, const Direction& d, const LocalColorRecall& recall) {
  Column recalled(sums, d.prefix + "recalled"), covered(sums, d.prefix + "covered");
  Column colored(sums, d.prefix + "colored");
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    const RecallClass found = recall.classes[slot];
    if (found == RecallClass::kNoColor) return;
    colored.add(part, 1.0);
    recalled.add(part, found == RecallClass::kRecalled ? 1.0 : 0.0);
    covered.add(part, found != RecallClass::kNotCovered ? 1.0 : 0.0);
  });
}

/// Values of voxels; NaN ones do not count.
class VoxelColumns {
 public:
  VoxelColumns(MetricSums& sums, const std::string& name, double voxel_m, const PartOf& part_of)
      : n_(sums, name + ".n"), sum_(sums, name + ".sum"), voxel_m_(voxel_m), part_of_(part_of) {}

  void add(const VoxelIndex& index, double value) {
    if (std::isnan(value)) return;
    const auto center = [&](std::size_t axis) { return (static_cast<double>(index[axis]) + 0.5) * voxel_m_; };
    const std::uint32_t part = part_of_({center(0), center(1), center(2)});
    n_.add(part, 1.0);
    sum_.add(part, value);
  }

 private:
  Column n_, sum_;
  double voxel_m_;
  const PartOf& part_of_;
};

void add_voxels(MetricSums& sums, const Findings& f, const PartOf& part_of) {
  const EvaluationOptions& o = f.options;
  if (f.selection.contains("color_consistency") && f.pair.has_color()) {
    VoxelColumns spread(sums, "color_spread", o.ccs_voxel_m, part_of);
    for (const auto& [index, trace] :
         voxel_color_spreads(f.pair.estimate, o.ccs_voxel_m, o.ccs_min_points, o.ccs_singletons)) {
      spread.add(index, trace);
    }
  }
  if (f.gaussians.empty()) return;
  const std::vector<VoxelDistance> distances = wasserstein_distances(f.gaussians);
  VoxelColumns wasserstein(sums, "wasserstein", o.awd_voxel_m, part_of);
  VoxelColumns variation(sums, "variation", o.awd_voxel_m, part_of);
  const std::vector<double> variations = local_variations(distances, static_cast<int>(o.scs_radius_voxels));
  for (std::size_t i = 0; i < distances.size(); ++i) {
    wasserstein.add(distances[i].index, distances[i].distance_m);
    variation.add(distances[i].index, variations[i]);
  }
}

void add_entropies(MetricSums& sums, const Direction& d, const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  Column n(sums, "entropy.n"), sum(sums, "entropy.sum");
  for_each_slot(d, [&](std::size_t slot, std::uint32_t part) {
    const double entropy = point_entropy(shape, slot, min_neighbors);
    if (std::isnan(entropy)) return;
    n.add(part, 1.0);
    sum.add(part, entropy);
  });
}

}  // namespace

MetricSums gathered_sums(const Findings& f, const LocalColorRecall* recall, const PartOf& of_estimate,
                         const PartOf& of_reference) {
  MetricSums sums;
  const Direction estimate{"estimate.", f.pair.estimate_to_reference(), parts_of(f.pair.estimate, of_estimate)};
  const Direction reference{"reference.", f.pair.reference_to_estimate(), parts_of(f.pair.reference, of_reference)};
  for (const Direction* d : {&estimate, &reference}) add_distances(sums, *d, f.options);
  if (f.pair.has_color()) add_colors(sums, f, estimate, reference);
  if (recall != nullptr) add_recall(sums, reference, *recall);
  add_voxels(sums, f, of_estimate);
  if (f.neighborhoods) add_entropies(sums, estimate, f.neighborhoods->estimate, f.options.mme_min_neighbors);
  for (const auto& [name, parts] : sums.columns) sums.n_parts = std::max(sums.n_parts, parts.size());
  for (auto& [name, parts] : sums.columns) parts.resize(sums.n_parts);
  return sums;
}

}  // namespace cmap
