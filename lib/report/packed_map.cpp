#include "report/packed_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/color.hpp"

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

constexpr unsigned kPositionBytes = 3;

/// Positions in steps of a millimeter, or as fine as three bytes reach.
void add_positions(PlaneWriter& writer, PackedMap& packed, const PointBlocks& points,
                   const Array<std::uint32_t>& slots) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (std::uint32_t slot : slots) {
    low = low.cwiseMin(points.world(slot));
    high = high.cwiseMax(points.world(slot));
  }
  constexpr double kMost = (1u << (8 * kPositionBytes)) - 1;
  const Eigen::Vector3d step = ((high - low) / kMost).cwiseMax(1e-3);
  packed.description["origin_m"] = {low.x(), low.y(), low.z()};
  packed.description["step_m"] = {step.x(), step.y(), step.z()};
  const char* names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    writer.add(names[axis], kPositionBytes, Json::object(), [&](std::uint32_t slot) {
      return static_cast<std::uint32_t>(std::lround((points.world(slot)[axis] - low[axis]) / step[axis]));
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

/// The page's planes hold numbers only: an error that is not there, for want of a color, is packed as 0.
template <class ErrorAt>
void add_error(PlaneWriter& writer, const char* field, const char* unit, const Array<std::uint32_t>& slots,
               ErrorAt&& error_at) {
  double most = 0.0;
  for (std::uint32_t slot : slots) most = std::max(most, error_at(slot));
  constexpr double kSteps = 65535.0;
  writer.add(field, 2, {{"max", most}, {"unit", unit}}, [&](std::uint32_t slot) {
    return most > 0.0 ? static_cast<std::uint32_t>(std::lround(kSteps * std::sqrt(error_at(slot) / most))) : 0u;
  });
}

std::array<double, 2> central_z_m(const PointBlocks& points, const Array<std::uint32_t>& slots) {
  Array<double> z;
  for (std::uint32_t slot : slots) z.push_back(points.world(slot).z());
  std::ranges::sort(z);
  const auto at = [&](double share) { return z[static_cast<std::size_t>(share * static_cast<double>(z.size() - 1))]; };
  return {at(0.01), at(0.99)};
}

}  // namespace

PackedMap pack_map(const IndexedMap& map, const Array<std::uint32_t>& slots) {
  const PointBlocks& points = map.index.points;
  PackedMap packed;
  packed.central_z_m = central_z_m(points, slots);
  packed.description = {{"points", slots.size()}, {"points_of_map", points.size}, {"planes", Json::array()}};
  PlaneWriter writer(packed, slots);
  add_positions(writer, packed, points, slots);
  if (map.has_color()) add_colors(writer, map);
  return packed;
}

PackedMap pack_map(const NearestPairs& pairs, const LocalColorRecall* recall, const Array<std::uint32_t>& slots) {
  PackedMap packed = pack_map(pairs.from, slots);
  PlaneWriter writer(packed, slots);
  add_error(writer, "distance", "m", slots, [&](std::uint32_t slot) { return pairs.distance_m(slot); });
  if (pairs.from.has_color() && pairs.to.has_color()) {
    add_error(writer, "color_distance", "unit RGB", slots,
              [&](std::uint32_t slot) { return pairs.has_colors(slot) ? pairs.color_distance(slot) : 0.0; });
  }
  if (recall != nullptr) {
    writer.add("lcr", 1, Json::object(),
               [&](std::uint32_t slot) { return static_cast<std::uint32_t>(recall->classes[slot]); });
  }
  return packed;
}

}  // namespace cmap
