#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/io/shift_hint.hpp"

namespace cmap {

/// Krueger's series to the third power of n, as in Karney, Transverse Mercator with an accuracy of a few nanometers,
/// Journal of Geodesy 2011, equations 7 to 11 and 35.
Eigen::Vector2d utm_of(double latitude_deg, double longitude_deg) {
  constexpr double kRadius_m = 6378137.0, kFlattening = 1.0 / 298.257223563, kScale = 0.9996;
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double zone = std::min(std::floor((longitude_deg + 180.0) / 6.0) + 1.0, 60.0);
  const double longitude = (longitude_deg - (6.0 * zone - 183.0)) * kRadians;

  const double e = std::sqrt(kFlattening * (2.0 - kFlattening));
  const double tau = std::tan(latitude_deg * kRadians);
  const double sigma = std::sinh(e * std::atanh(e * tau / std::hypot(1.0, tau)));
  const double conformal = tau * std::hypot(1.0, sigma) - sigma * std::hypot(1.0, tau);
  const double xi = std::atan2(conformal, std::cos(longitude));
  const double eta = std::asinh(std::sin(longitude) / std::hypot(conformal, std::cos(longitude)));

  const double n = kFlattening / (2.0 - kFlattening), n2 = n * n, n3 = n2 * n;
  const double alpha[] = {n / 2.0 - 2.0 * n2 / 3.0 + 5.0 * n3 / 16.0, 13.0 * n2 / 48.0 - 3.0 * n3 / 5.0,
                          61.0 * n3 / 240.0};
  double north = xi, east = eta;
  for (int j = 1; j <= 3; ++j) {
    north += alpha[j - 1] * std::sin(2 * j * xi) * std::cosh(2 * j * eta);
    east += alpha[j - 1] * std::cos(2 * j * xi) * std::sinh(2 * j * eta);
  }
  const double radius_m = kScale * kRadius_m / (1.0 + n) * (1.0 + n2 / 4.0 + n2 * n2 / 64.0);
  return {500000.0 + radius_m * east, (latitude_deg < 0.0 ? 1e7 : 0.0) + radius_m * north};
}

}  // namespace cmap
