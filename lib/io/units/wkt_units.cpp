#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cmap/core/spelling.hpp"
#include "cmap/io/number_text.hpp"
#include "units/coordinate_units.hpp"
#include "units/wkt.hpp"

namespace cmap {
namespace {

constexpr double kDegree_rad = 0.017453292519943295;
const std::initializer_list<std::string_view> kVerticalNodes{"VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"};

/// A unit among a node's own children: not of the geographic system that a projection starts from.
const WktNode* unit_of(const WktNode& node) {
  const WktNode* unit = node.child({"UNIT", "LENGTHUNIT"});
  return unit != nullptr && unit->values.size() > 1 ? unit : nullptr;
}

/// The unit of an axis (0, 1, 2): the coordinate system's or, in WKT 2, the axis's own.
const WktNode* axis_unit(const WktNode& system, std::size_t axis) {
  for (const WktNode& child : system.children) {
    if (!child.is({"AXIS"}) || axis-- > 0) continue;
    if (const WktNode* unit = unit_of(child)) return unit;
    break;
  }
  return unit_of(system);
}

double factor_of(const WktNode& unit) {
  double factor = 0.0;
  return parse_number(unit.values[1], factor) ? factor : 0.0;
}

/// Whether a unit is a foot by its name and a meter by its factor, as some libraries wrote that of heights.
bool is_contradiction(const WktNode& unit) {
  const std::string name = lower_case(unit.values[0]);
  return factor_of(unit) == 1.0 && (name.find("foot") != name.npos || name.find("feet") != name.npos);
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

void read_length(const WktNode* unit, std::optional<double>& unit_m, CoordinateUnits& units) {
  if (unit == nullptr) return;
  if (is_contradiction(*unit)) {
    units.problem = fmt::format("a unit named {} whose factor is that of a meter", unit->values[0]);
    return;
  }
  unit_m = exact_unit_m(factor_of(*unit));
  if (!unit_m) units.problem = fmt::format("a unit named {} whose factor is none", unit->values[0]);
}

void read_vertical(const WktNode& system, CoordinateUnits& units) {
  read_length(axis_unit(system, 0), units.vertical_m, units);
}

void read_horizontal(const WktNode& system, CoordinateUnits& units) {
  const WktNode* unit = axis_unit(system, 0);
  // A few projected systems (Plate Carree) are counted in degrees.
  units.angular = is_angular(system) || (unit != nullptr && std::abs(factor_of(*unit) - kDegree_rad) < 1e-8);
  if (units.angular) return;
  read_length(unit, units.horizontal_m, units);
  if (has_third_axis(system)) read_length(axis_unit(system, 2), units.vertical_m, units);
  // Some writers put the system of the heights inside.
  if (const WktNode* heights = system.child(kVerticalNodes)) read_vertical(*heights, units);
}

/// The systems of x, y and z, which a compound or a bound one holds.
void read_system(const WktNode& system, CoordinateUnits& units) {
  if (units.system.empty() && !system.values.empty()) units.system = system.values[0];
  if (system.is({"COMPD_CS", "COMPOUNDCRS", "SOURCECRS"})) {
    for (const WktNode& part : system.children) read_system(part, units);
  } else if (system.is({"BOUNDCRS"})) {
    if (const WktNode* source = system.child({"SOURCECRS"})) read_system(*source, units);
  } else if (system.is(kVerticalNodes)) {
    read_vertical(system, units);
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
