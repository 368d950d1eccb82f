#include "units/coordinate_units.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cmap {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kSurveyFoot_m = 1200.0 / 3937.0;

}  // namespace

std::optional<double> exact_unit_m(double factor) {
  if (!(factor >= 1e-6 && factor <= 1e6)) return std::nullopt;
  // Seven digits of the survey foot would move a state plane by centimeters; the two feet differ by 2e-6.
  for (const double known : {1.0, kFoot_m, kSurveyFoot_m}) {
    if (std::abs(factor - known) <= 2e-7 * known) return known;
  }
  return factor;
}

std::string unit_name(double unit_m) {
  if (unit_m == 1.0) return "meters";
  if (unit_m == kFoot_m) return "feet";
  if (unit_m == kSurveyFoot_m) return "US survey feet";
  return fmt::format("units of {:g} m", unit_m);
}

}  // namespace cmap
