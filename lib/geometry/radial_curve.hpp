#pragma once

#include <array>
#include <optional>

namespace cmap {

/// How a lens moves a point away from the center: r becomes r N(s)/D(s) with s = r^2. r is the tangent of the angle to
/// the optical axis (pinhole) or the angle itself (fisheye).
struct RadialCurve {
  std::array<double, 5> numerator{1.0, 0.0, 0.0, 0.0, 0.0};  ///< of s^0, s^1, ...
  std::array<double, 4> denominator{1.0, 0.0, 0.0, 0.0};

  /// N(s)/D(s) and its derivative by s.
  double factor(double s) const;
  double factor_slope(double s) const;
  /// Whether the curve rises all the way from 0 to r, so that nothing nearer has the same image.
  bool rises_to(double r) const;
  /// The r on the first rising part whose image is r_distorted >= 0; none beyond the fold.
  std::optional<double> inverse(double r_distorted) const;
};

}  // namespace cmap
