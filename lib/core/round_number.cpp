#include "cmap/core/round_number.hpp"

#include <cmath>
#include <initializer_list>

namespace cmap {

double round_number_above(double value) {
  if (!(value > 0.0)) return 1.0;
  const double exponent = std::floor(std::log10(value));
  // Divided by a power of ten, not multiplied with its rounded inverse: 3 / 10 is 0.3.
  const auto scaled = [&](double step) {
    return exponent < 0.0 ? step / std::pow(10.0, -exponent) : step * std::pow(10.0, exponent);
  };
  for (double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (value <= scaled(step) * (1.0 + 1e-9)) return scaled(step);
  }
  return scaled(10.0);
}

}  // namespace cmap
