#include "packed_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cmap/geometry/color.hpp"
#include "cmap/geometry/core_box.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Appends a plane of values below 2^(8 n_bytes).
class PlaneWriter {
 public:
  PlaneWriter(PackedMap& map, const Array<std::uint32_t>& slots) : map_(map), slots_(slots) {}

  template <class ValueAt>
  void add(const char* field, unsigned n_bytes, Json more, ValueAt&& value_at) {
    const unsigned bits = 8 * n_bytes;
    const std::uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
    const std::size_t n = slots_.size(), begin = map_.bytes.size();
    map_.bytes.resize(begin + n * n_bytes);
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t value = value_at(slots_[i]);
      const std::uint32_t difference = (value - before) & mask;
      const bool negative = (difference >> (bits - 1)) != 0;
      const std::uint32_t zigzag = ((difference << 1) ^ (negative ? mask : 0)) & mask;
      before = value;
      for (unsigned k = 0; k < n_bytes; ++k) map_.bytes[begin + k * n + i] = static_cast<char>(zigzag >> (8 * k));
    }
    Json plane{{"field", field}, {"type", fmt::format("u{}", bits)}};
    plane.update(more);
    map_.description["planes"].push_back(std::move(plane));
  }

 private:
  PackedMap& map_;
  const Array<std::uint32_t>& slots_;
};

/// A millimeter, or of small maps the power of ten below a ten thousandth of their diagonal: the page has far fewer
/// points across a surface.
double finest_step_m(const Box3d& core) {
  constexpr double kLargest_m = 1e-3, kStepsAcross = 1e4;
  const double diagonal_m = (core.max - core.min).norm();
  if (!(diagonal_m > 0.0)) return kLargest_m;
  return std::min(kLargest_m, std::pow(10.0, std::floor(std::log10(diagonal_m / kStepsAcross))));
}

constexpr unsigned kPositionBytes = 3;

/// Points are counted in steps from one corner.
struct PositionGrid {
  /// As fine as asked for, or as three bytes reach.
  PositionGrid(const PointBlocks& points, std::span<const std::uint32_t> slots, double finest_m) {
    Eigen::Vector3d high = -origin;
    for (std::uint32_t slot : slots) {
      origin = origin.cwiseMin(points.world(slot));
      high = high.cwiseMax(points.world(slot));
    }
    constexpr double kMost = (1u << (8 * kPositionBytes)) - 1;
    step = ((high - origin) / kMost).cwiseMax(finest_m);
  }
  std::uint32_t at(const Eigen::Vector3d& p, int axis) const {
    return static_cast<std::uint32_t>(std::lround((p[axis] - origin[axis]) / step[axis]));
  }

  Eigen::Vector3d origin = Eigen::Vector3d::Constant(INFINITY), step;
};

/// The points of a page, strays last.
struct PageSlots {
  PageSlots(const PointBlocks& points, const Array<std::uint32_t>& all)
      : core(cloud_core(points.size, [&](std::size_t slot) { return points.world(slot); })), slots(all) {
    const auto strays =
        std::ranges::stable_partition(slots, [&](std::uint32_t slot) { return !core.is_stray(points.world(slot)); });
    n_near = slots.size() - strays.size();
  }

  CloudCore core;
  Array<std::uint32_t> slots;
  std::size_t n_near;
};

/// Strays have a grid of their own, so that they do not coarsen that of the map.
void add_positions(PlaneWriter& writer, PackedMap& packed, const PointBlocks& points, const PageSlots& page) {
  const std::span<const std::uint32_t> slots(page.slots);
  std::vector<PositionGrid> grids;
  for (const auto part : {slots.first(page.n_near), slots.subspan(page.n_near)}) {
    const PositionGrid& grid = grids.emplace_back(points, part, finest_step_m(page.core.box));
    if (part.empty()) continue;
    packed.description["grids"].push_back({{"points", part.size()},
                                           {"origin_m", {grid.origin.x(), grid.origin.y(), grid.origin.z()}},
                                           {"step_m", {grid.step.x(), grid.step.y(), grid.step.z()}}});
  }
  const char* names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    writer.add(names[axis], kPositionBytes, Json::object(), [&](std::uint32_t slot) {
      const Eigen::Vector3d p = points.world(slot);
      return grids[page.core.is_stray(p) ? 1 : 0].at(p, axis);
    });
  }
}

void add_colors(PlaneWriter& writer, const IndexedMap& map) {
  const char* names[] = {"r", "g", "b"};
  for (std::size_t c = 0; c < 3; ++c) {
    writer.add(names[c], 1, Json::object(),
               [&](std::uint32_t slot) -> std::uint32_t { return to_rgb8(color_at(map.colors, slot))[c]; });
  }
}

/// An error that is not there (NaN) has the last code. Strays have a largest error of their own, which would coarsen
/// the others.
template <class ErrorAt>
void add_error(PackedMap& packed, const char* field, const char* unit, const PointBlocks& points, const PageSlots& page,
               ErrorAt&& error_at) {
  std::array<double, 2> most{};
  const auto most_of = [&](std::uint32_t slot) -> double& {
    return most[page.core.is_stray(points.world(slot)) ? 1 : 0];
  };
  for (std::uint32_t slot : page.slots) most_of(slot) = std::max(most_of(slot), error_at(slot));
  constexpr std::uint32_t kNone = 65535;
  constexpr double kSteps = 65534.0;
  PlaneWriter(packed, page.slots).add(field, 2, {{"max", most}, {"unit", unit}}, [&](std::uint32_t slot) {
    const double error = error_at(slot), largest = most_of(slot);
    if (std::isnan(error)) return kNone;
    return largest > 0.0 ? static_cast<std::uint32_t>(std::lround(kSteps * std::sqrt(error / largest))) : 0u;
  });
}

PackedMap packed_look(const IndexedMap& map, const PageSlots& page) {
  const PointBlocks& points = map.index.points;
  PackedMap packed;
  packed.description = {{"points", page.slots.size()},
                        {"points_of_map", points.size},
                        {"grids", Json::array()},
                        {"planes", Json::array()}};
  PlaneWriter writer(packed, page.slots);
  add_positions(writer, packed, points, page);
  if (map.has_color()) add_colors(writer, map);
  return packed;
}

}  // namespace

PackedMap pack_map(const IndexedMap& map, const Array<std::uint32_t>& slots) {
  return packed_look(map, PageSlots(map.index.points, slots));
}

PackedMap pack_map(const NearestPairs& pairs, const LocalColorRecall* recall, const Array<std::uint32_t>& slots) {
  const PointBlocks& points = pairs.from.index.points;
  const PageSlots page(points, slots);
  PackedMap packed = packed_look(pairs.from, page);
  add_error(packed, "distance", "m", points, page, [&](std::uint32_t slot) { return pairs.distance_m(slot); });
  if (pairs.from.has_color() && pairs.to.has_color()) {
    add_error(packed, "color_distance", "unit RGB", points, page,
              [&](std::uint32_t slot) { return pairs.color_distance(slot); });
  }
  if (recall != nullptr) {
    PlaneWriter(packed, page.slots).add("lcr", 1, Json::object(), [&](std::uint32_t slot) {
      return static_cast<std::uint32_t>(recall->classes[slot]);
    });
  }
  return packed;
}

}  // namespace cmap
