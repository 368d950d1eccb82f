#pragma once

#include <functional>

#include "cmap/eval/metric_sums.hpp"
#include "eval/metric_records.hpp"

namespace cmap {

/// The part of space in which a place lies; called once for every point and voxel, in an order that is always the same.
using PartOf = std::function<std::uint32_t(const Eigen::Vector3d& world)>;

/// The sums of the selected metrics over the parts that `of_estimate` and `of_reference` tell of each map's points;
/// voxels count where their centers lie. `recall` is null where there is none.
MetricSums gathered_sums(const Findings& findings, const LocalColorRecall* recall, const PartOf& of_estimate,
                         const PartOf& of_reference);

}  // namespace cmap
