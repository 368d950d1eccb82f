#include <cmath>

#include "io/coordinate_units.hpp"
#include "io/number_text.hpp"
#include "io/wkt.hpp"

namespace cmap {
namespace {

constexpr double kDegree_rad = 0.017453292519943295;

/// The factor of a unit among a node's own children: not of the geographic system that a projection starts from.
std::optional<double> factor_of(const WktNode& node) {
  const WktNode* unit = node.child({"UNIT", "LENGTHUNIT"});
  if (unit == nullptr || unit->values.size() < 2) return std::nullopt;
  double factor = 0.0;
  return parse_number(unit->values[1], factor) ? std::optional(factor) : std::nullopt;
}

/// The unit of an axis (0, 1, 2): the coordinate system's or, in WKT 2, the axis's own.
std::optional<double> axis_factor(const WktNode& system, std::size_t axis) {
  for (const WktNode& child : system.children) {
    if (!child.is({"AXIS"}) || axis-- > 0) continue;
    if (const auto factor = factor_of(child)) return factor;
    break;
  }
  return factor_of(system);
}

bool has_third_axis(const WktNode& system) {
  std::size_t n = 0;
  for (const WktNode& child : system.children) n += child.is({"AXIS"}) ? 1 : 0;
  return n > 2;
}

bool is_angular(const WktNode& system) {
  if (system.is({"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"})) return true;
  if (!system.is({"GEODCRS", "GEODETICCRS"})) return false;
  const WktNode* axes = system.child({"CS"});
  return axes == nullptr || axes->values.empty() || axes->values[0] != "Cartesian";
}

bool is_vertical(const WktNode& system) { return system.is({"VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"}); }

void read_length(std::optional<double> factor, std::optional<double>& unit_m, CoordinateUnits& units) {
  if (!factor) return;
  unit_m = exact_unit_m(*factor);
  if (!unit_m) units.problem = "a unit of length with a factor that is none";
}

void read_horizontal(const WktNode& system, CoordinateUnits& units) {
  const std::optional<double> factor = axis_factor(system, 0);
  // A few projected systems (Plate Carree) are counted in degrees.
  units.angular = is_angular(system) || (factor && std::abs(*factor - kDegree_rad) < 1e-8);
  if (units.angular) return;
  read_length(factor, units.horizontal_m, units);
  if (has_third_axis(system)) read_length(axis_factor(system, 2), units.vertical_m, units);
}

/// The systems of x, y and z, which a compound or a bound one holds.
void read_system(const WktNode& system, CoordinateUnits& units) {
  if (units.system.empty() && !system.values.empty()) units.system = system.values[0];
  if (system.is({"COMPD_CS", "COMPOUNDCRS", "SOURCECRS"})) {
    for (const WktNode& part : system.children) read_system(part, units);
  } else if (system.is({"BOUNDCRS"})) {
    if (const WktNode* source = system.child({"SOURCECRS"})) read_system(*source, units);
  } else if (is_vertical(system)) {
    read_length(axis_factor(system, 0), units.vertical_m, units);
  } else if (system.is({"PROJCS", "PROJCRS", "PROJECTEDCRS", "DERIVEDPROJCRS", "GEOCCS", "LOCAL_CS", "ENGCRS",
                        "ENGINEERINGCRS"}) ||
             is_angular(system) || system.is({"GEODCRS", "GEODETICCRS"})) {
    read_horizontal(system, units);
  }
}

}  // namespace

CoordinateUnits units_from_wkt(std::string_view wkt) {
  CoordinateUnits units;
  const auto systems = parse_wkt(wkt.substr(0, wkt.find('\0')));
  if (!systems) {
    units.problem = "well-known text that is malformed";
    return units;
  }
  for (const WktNode& system : *systems) read_system(system, units);
  return units;
}

}  // namespace cmap
