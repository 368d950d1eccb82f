#include "cmap/geometry/color.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cmap {
namespace {

double linear_from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29.0;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

double pow7(double v) { return std::pow(v, 7.0); }

/// Hue angle in degrees [0, 360); 0 for a neutral color (Sharma et al., equation 7).
double hue_deg(double a, double b) {
  if (a == 0.0 && b == 0.0) return 0.0;
  const double hue = std::atan2(b, a) * 180.0 / std::numbers::pi;
  return hue < 0.0 ? hue + 360.0 : hue;
}

/// Opposite hues are 180 degrees apart up to rounding; the published pairs take them as not above 180.
constexpr double kOpposite_deg = 180.0 + 1e-9;

/// Hue difference in degrees (equation 10).
double hue_difference(double hue1, double hue2) {
  const double difference = hue2 - hue1;
  if (difference > kOpposite_deg) return difference - 360.0;
  return difference < -kOpposite_deg ? difference + 360.0 : difference;
}

/// Mean hue in degrees of two chromatic colors (equation 14).
double mean_hue(double hue1, double hue2) {
  const double sum = hue1 + hue2;
  if (std::abs(hue1 - hue2) <= kOpposite_deg) return sum / 2.0;
  return sum < 360.0 ? (sum + 360.0) / 2.0 : (sum - 360.0) / 2.0;
}

}  // namespace

RgbF rgb_255(const Colors& colors, std::size_t i) {
  if (const auto* c = std::get_if<Array<Rgb8>>(&colors)) return rgb_255((*c)[i]);
  if (const auto* c = std::get_if<Array<Rgb16>>(&colors)) return rgb_255((*c)[i]);
  if (const auto* c = std::get_if<Array<RgbF>>(&colors)) return rgb_255((*c)[i]);
  throw std::invalid_argument("rgb_255: the cloud has no colors");
}

Rgb8 to_rgb8(const Eigen::Vector3f& rgb_255) {
  // fmax and fmin leave NaN out: it becomes 0.
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround(std::fmin(std::fmax(v, 0.0f), 255.0f)));
  };
  return {byte(rgb_255.x()), byte(rgb_255.y()), byte(rgb_255.z())};
}

Eigen::Vector3d srgb_to_lab(const Eigen::Vector3d& rgb) {
  const Eigen::Vector3d linear = rgb.unaryExpr(&linear_from_srgb);
  // IEC 61966-2-1, D65.
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124564, 0.3575761, 0.1804375,  //
      0.2126729, 0.7151522, 0.0721750,              //
      0.0193339, 0.1191920, 0.9503041;
  const Eigen::Vector3d white = xyz_from_rgb.rowwise().sum();  // so that white is exactly L* = 100
  const Eigen::Vector3d f = (xyz_from_rgb * linear).cwiseQuotient(white).unaryExpr(&lab_curve);
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

double delta_e_2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  const double mean_chroma_ab = 0.5 * (std::hypot(lab1.y(), lab1.z()) + std::hypot(lab2.y(), lab2.z()));
  const double chroma7 = pow7(mean_chroma_ab);
  const double g = 0.5 * (1.0 - std::sqrt(chroma7 / (chroma7 + pow7(25.0))));
  const double a1 = (1.0 + g) * lab1.y();
  const double a2 = (1.0 + g) * lab2.y();
  const double chroma1 = std::hypot(a1, lab1.z());
  const double chroma2 = std::hypot(a2, lab2.z());
  const double hue1 = hue_deg(a1, lab1.z());
  const double hue2 = hue_deg(a2, lab2.z());
  const bool chromatic = chroma1 * chroma2 != 0.0;

  const double d_lightness = lab2.x() - lab1.x();
  const double d_chroma = chroma2 - chroma1;
  const double d_hue_deg = chromatic ? hue_difference(hue1, hue2) : 0.0;
  const double d_hue = 2.0 * std::sqrt(chroma1 * chroma2) * std::sin(radians(d_hue_deg) / 2.0);

  const double lightness = 0.5 * (lab1.x() + lab2.x());
  const double chroma = 0.5 * (chroma1 + chroma2);
  const double hue = chromatic ? mean_hue(hue1, hue2) : hue1 + hue2;
  const double t = 1.0 - 0.17 * std::cos(radians(hue - 30.0)) + 0.24 * std::cos(radians(2.0 * hue)) +
                   0.32 * std::cos(radians(3.0 * hue + 6.0)) - 0.20 * std::cos(radians(4.0 * hue - 63.0));
  const double lightness50 = (lightness - 50.0) * (lightness - 50.0);
  const double s_lightness = 1.0 + 0.015 * lightness50 / std::sqrt(20.0 + lightness50);
  const double s_chroma = 1.0 + 0.045 * chroma;
  const double s_hue = 1.0 + 0.015 * chroma * t;
  const double rotation_deg = 30.0 * std::exp(-std::pow((hue - 275.0) / 25.0, 2.0));
  const double rotation_chroma = 2.0 * std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25.0)));
  const double rotation = -std::sin(radians(2.0 * rotation_deg)) * rotation_chroma;

  const double l = d_lightness / s_lightness;
  const double c = d_chroma / s_chroma;
  const double h = d_hue / s_hue;
  return std::sqrt(l * l + c * c + h * h + rotation * c * h);
}

Eigen::Vector3d rgb_to_ycbcr709(const Eigen::Vector3d& rgb) {
  return {0.2126 * rgb.x() + 0.7152 * rgb.y() + 0.0722 * rgb.z(), -0.1146 * rgb.x() - 0.3854 * rgb.y() + 0.5 * rgb.z(),
          0.5 * rgb.x() - 0.4542 * rgb.y() - 0.0458 * rgb.z()};
}

}  // namespace cmap
