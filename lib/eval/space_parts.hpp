#pragma once

#include <functional>

#include "cmap/metrics/metric_sums.hpp"

namespace cmap {

/// The part of space in which a place lies; called once for every point and voxel, in an order that is always the same.
using PartOf = std::function<std::uint32_t(const Eigen::Vector3d& world)>;

/// The parts of both maps' points; voxels are in the parts of the estimate's.
inline SpaceParts space_parts(const MapPair& pair, const PartOf& of_estimate, const PartOf& of_reference) {
  const auto of_slots = [](const IndexedMap& map, const PartOf& part_of) {
    Array<std::uint32_t> parts(map.size());
    for (std::size_t slot = 0; slot < map.size(); ++slot) parts[slot] = part_of(map.index.points.world(slot));
    return parts;
  };
  SpaceParts parts;
  parts.of_slots.estimate = of_slots(pair.estimate, of_estimate);
  parts.of_slots.reference = of_slots(pair.reference, of_reference);
  parts.of_voxel = of_estimate;
  return parts;
}

}  // namespace cmap
