#include "radial_curve.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace cmap {
namespace {

/// The sign of the curve's slope is that of N D + 2 s (N' D - N D'), a polynomial in s of this degree.
constexpr std::size_t kDegree = 7;
using Polynomial = std::array<double, kDegree + 1>;

template <std::size_t n>
double horner(const std::array<double, n>& coefficients, double s) {
  double value = 0.0;
  for (std::size_t i = n; i-- > 0;) value = value * s + coefficients[i];
  return value;
}

template <std::size_t n>
double horner_slope(const std::array<double, n>& coefficients, double s) {
  double value = 0.0;
  for (std::size_t i = n; i-- > 1;) value = value * s + static_cast<double>(i) * coefficients[i];
  return value;
}

std::size_t degree_of(const Polynomial& polynomial) {
  std::size_t degree = kDegree;
  while (degree > 0 && polynomial[degree] == 0.0) --degree;
  return degree;
}

/// Whether a polynomial in Bernstein form is positive on its interval: surely so if all coefficients are, surely not if
/// one at an end is not; else the halves are asked. An interval cut this often touches zero.
bool bernstein_is_positive(Polynomial coefficients, std::size_t degree, int cuts_left) {
  if (!(coefficients[0] > 0.0) || !(coefficients[degree] > 0.0)) return false;
  bool all = true;
  for (std::size_t i = 1; i < degree; ++i) all = all && coefficients[i] > 0.0;
  if (all) return true;
  if (cuts_left == 0) return false;
  Polynomial left{};
  for (std::size_t i = 0; i <= degree; ++i) {  // de Casteljau at the middle; `coefficients` become the right half
    left[i] = coefficients[0];
    for (std::size_t k = 0; k + i < degree; ++k) coefficients[k] = 0.5 * (coefficients[k] + coefficients[k + 1]);
  }
  Polynomial right{};
  for (std::size_t i = 0; i <= degree; ++i) right[i] = coefficients[i];
  return bernstein_is_positive(left, degree, cuts_left - 1) && bernstein_is_positive(right, degree, cuts_left - 1);
}

/// Whether a polynomial is positive on [0, end].
bool is_positive(const Polynomial& polynomial, double end) {
  constexpr int kCuts = 30;
  const std::size_t degree = degree_of(polynomial);
  Polynomial bernstein{};
  double power = 1.0;
  for (std::size_t k = 0; k <= degree; ++k, power *= end) {
    // b_i = sum_k C(i,k)/C(degree,k) a_k; the quotient for i = k, k+1, ... from the one before.
    double quotient = 1.0;
    for (std::size_t j = 0; j < k; ++j) quotient *= static_cast<double>(k - j) / static_cast<double>(degree - j);
    for (std::size_t i = k; i <= degree; ++i) {
      bernstein[i] += quotient * polynomial[k] * power;
      quotient *= static_cast<double>(i + 1) / static_cast<double>(i + 1 - k);
    }
  }
  return bernstein_is_positive(bernstein, degree, kCuts);
}

/// What nearly every lens needs; none where Newton's steps do not settle before the fold.
std::optional<double> newton_inverse(const RadialCurve& curve, double r_distorted) {
  constexpr int kSteps = 10;
  const double enough = 4.0 * std::numeric_limits<double>::epsilon() * r_distorted;
  double r = r_distorted;
  for (int step = 0; step < kSteps; ++step) {
    const double s = r * r;
    const double error = r * curve.factor(s) - r_distorted;
    if (std::abs(error) <= enough) return r >= 0.0 && curve.rises_to(r) ? std::optional(r) : std::nullopt;
    r -= error / (curve.factor(s) + 2.0 * s * curve.factor_slope(s));
  }
  return std::nullopt;
}

}  // namespace

double RadialCurve::factor(double s) const { return horner(numerator, s) / horner(denominator, s); }

double RadialCurve::factor_slope(double s) const {
  const double n = horner(numerator, s), d = horner(denominator, s);
  return (horner_slope(numerator, s) * d - n * horner_slope(denominator, s)) / (d * d);
}

bool RadialCurve::rises_to(double r) const {
  Polynomial slope{}, below{};
  for (std::size_t i = 0; i < numerator.size(); ++i) {
    for (std::size_t j = 0; j < denominator.size(); ++j) {
      slope[i + j] += numerator[i] * denominator[j] * (1.0 + 2.0 * (static_cast<double>(i) - static_cast<double>(j)));
    }
  }
  for (std::size_t j = 0; j < denominator.size(); ++j) below[j] = denominator[j];
  // Past a zero of the denominator the curve comes back from the other infinity, rising again.
  return is_positive(slope, r * r) && is_positive(below, r * r);
}

std::optional<double> RadialCurve::inverse(double r_distorted) const {
  constexpr double kFarthest = 1e6;  // of a pinhole: the horizon to 1e-6
  if (const auto r = newton_inverse(*this, r_distorted)) return r;
  const auto image = [&](double r) { return r * factor(r * r); };
  double low = 0.0, high = r_distorted;
  while (rises_to(high) && image(high) < r_distorted) {
    low = high;
    high *= 2.0;
    if (high > kFarthest) return std::nullopt;
  }
  // The image lies between low and high, or the fold does: both are found by halving, to the last bit.
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (rises_to(middle) && image(middle) < r_distorted ? low : high) = middle;
  }
  if (!rises_to(high)) return std::nullopt;
  return high;
}

}  // namespace cmap
