#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "cmap/metrics/map_pair.hpp"
#include "cmap/spatial/threshold.hpp"

namespace cmap {

/// What local color recall finds at a reference point.
enum class RecallClass : std::uint8_t { kNotCovered = 0, kWrongColor = 1, kRecalled = 2, kNoColor = 3 };

/// A class for people, with a color that stays apart from the others' for every kind of color blindness (Okabe and Ito
/// 2008).
struct RecallClassLook {
  std::string_view label;
  Rgb8 color;
};
inline constexpr std::array<RecallClassLook, 4> kRecallClassLooks{{{"not covered", {187, 187, 187}},
                                                                   {"wrong color", {213, 94, 0}},
                                                                   {"recalled", {0, 114, 178}},
                                                                   {"no color of its own", {85, 85, 85}}}};

inline const RecallClassLook& look_of(RecallClass c) { return kRecallClassLooks[static_cast<std::size_t>(c)]; }

struct LocalColorRecallOptions {
  double tau = 0.1;                       ///< a color is right within 3 tau (unit RGB)
  double radius_m = 0.5;                  ///< r_g
  bool curve = false;                     ///< also for tau = 0.02, 0.04 ... 0.30
  double radius_steps = kThresholdSteps;  ///< that a distance may exceed the radius by (spatial/threshold.hpp)
};

struct RecallCurve {
  std::vector<double> tau;
  std::vector<double> value;
  double area = 0.0;  ///< trapezoids under the curve over its range of tau, divided by that range
};

/// What local color recall LCR (paper) is the mean of: whether a reference point has an estimated point within radius_m
/// whose color differs by at most 3 tau. 8-bit colors are compared in exact integers, distances in double. Reference
/// points without color (NaN) count nowhere; estimated points without color cover, as coverage is geometric, but never
/// recall.
struct LocalColorRecall {
  RecallCurve curve;           ///< empty unless asked for
  Array<RecallClass> classes;  ///< by reference slot
};

/// The largest squared distance (units of 1/255) between colors that counts as right: within 3 tau.
float right_color_limit(double tau);

/// Both maps need colors (std::invalid_argument). The same for any number of threads.
LocalColorRecall find_recall(const MapPair& pair, const LocalColorRecallOptions& options);

}  // namespace cmap
