#include <fmt/format.h>

#include <array>

#include "plausibility.hpp"

namespace cmap {
namespace {

constexpr double kDifferentSizes = 2.5;  // networks give maps of a third; a part of a map is seldom below
constexpr double kDifferentUnits = 100.0;
constexpr std::uint64_t kFewestForSizes = 10;  // points, below which only units are told from sizes

struct Unit {
  const char* name;
  double per_meter;
};
constexpr std::array<Unit, 4> kUnits{
    {{"millimeters", 1000.0}, {"centimeters", 100.0}, {"feet", 3.28084}, {"inches", 39.3701}}};

/// What may explain that one map is larger by `factor`.
std::string guess(const char* larger, double factor) {
  const double alike = factor < 10.0 ? 0.05 : 0.15;  // 3 is no foot
  for (const Unit& unit : kUnits) {
    if (std::abs(factor / unit.per_meter - 1.0) > alike) continue;
    return fmt::format("is the {} in {} (the unit here is the meter)?", larger, unit.name);
  }
  return "is one in other units, in a scale of its own as networks give, or only a part of the other?";
}

void warn_about_sizes(const CloudBody& reference, const CloudBody& estimate, std::vector<Warning>& warnings) {
  const double reference_m = reference.core_diagonal_m(), estimate_m = estimate.core_diagonal_m();
  const double different = std::min(reference.n, estimate.n) < kFewestForSizes ? kDifferentUnits : kDifferentSizes;
  const double smaller_m = std::min(reference_m, estimate_m), larger_m = std::max(reference_m, estimate_m);
  if (larger_m < different * smaller_m || larger_m == 0.0) return;
  std::string factor, why = "do all points of one stand at one place?";
  if (smaller_m > 0.0) {
    factor = fmt::format(", a factor of {:.4g}", larger_m / smaller_m);
    why = guess(reference_m > estimate_m ? "reference" : "estimate", larger_m / smaller_m);
  }
  warnings.push_back(
      {"units_or_frame_mismatch", fmt::format("the reference spans {:.6g} m and the estimate {:.6g} m{}: {}",
                                              reference_m, estimate_m, factor, why)});
}

}  // namespace

void warn_about_frames(const CloudBody& reference, const CloudBody& estimate, std::vector<Warning>& warnings) {
  warn_about_sizes(reference, estimate, warnings);
  const double gap_m = gap_between(reference.box, estimate.box);
  constexpr double kApart = 0.01;  // of the smaller map: two floors 2 cm apart are in one frame
  if (gap_m > kApart * std::min(reference.core_diagonal_m(), estimate.core_diagonal_m())) {
    warnings.push_back({"units_or_frame_mismatch",
                        fmt::format("the maps' boxes are {:.4g} m apart: are both in the reference frame?", gap_m)});
  }
  if (gap_m > kFarApart_m) {
    warnings.push_back(
        {"precision_reduced",
         fmt::format("the maps are {:.4g} km apart: distances are rounded to single precision there", gap_m / 1e3)});
  }
}

}  // namespace cmap
