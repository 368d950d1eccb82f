#pragma once

#include "cmap/eval/evaluation.hpp"
#include "cmap/metrics/distances.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {

/// The neighborhoods of both maps' points, where mean map entropy or MapEval's is asked for.
struct Neighborhoods {
  NeighborhoodShape reference;
  NeighborhoodShape estimate;
};

/// What the records are made from; whatever is not needed is left empty.
struct Findings {
  const EvaluationOptions& options;
  const MetricSelection& selection;
  const MapPair& pair;
  DistanceStats estimate_to_reference;  ///< thresholds: the options' and, last, the overlap distance
  DistanceStats reference_to_estimate;
  std::vector<GaussianPair> gaussians;
  std::optional<Neighborhoods> neighborhoods;
  std::span<const Eigen::Vector3d> sensor_positions;  ///< of the estimate's sensor, reference frame; empty: not known
};

/// The records of one family, those that are selected, in the catalog's order; warnings are appended.
std::vector<MetricRecord> geometry_records(const Findings& findings);
std::vector<MetricRecord> color_records(const Findings& findings, std::optional<LocalColorRecall>& recall,
                                        std::vector<Warning>& warnings);
std::vector<MetricRecord> distribution_records(const Findings& findings, std::vector<Warning>& warnings);
std::vector<MetricRecord> entropy_records(const Findings& findings, std::vector<Warning>& warnings);
std::vector<MetricRecord> density_records(const Findings& findings, std::vector<Warning>& warnings);

/// The fields of a metric that needs no reference, for one map; warnings are appended. The map of color_consistency has
/// color.
nlohmann::ordered_json color_consistency_fields(const EvaluationOptions& options, const IndexedMap& map,
                                                std::vector<Warning>& warnings);
nlohmann::ordered_json mean_map_entropy_fields(const EvaluationOptions& options, const NeighborhoodShape& neighborhoods,
                                               std::vector<Warning>& warnings);
nlohmann::ordered_json point_spacing_fields(const IndexedMap& map, std::vector<Warning>& warnings);

/// The selected color metrics of maps without color: null.
std::vector<MetricRecord> missing_color_records(const MetricSelection& selection);

}  // namespace cmap
