#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// A color as RGB in units of 1/255, whatever the storage: 8-bit values stay exact integers, 16-bit ones are divided by
/// 257, float ones multiplied by 255.
inline RgbF rgb_255(const Rgb8& c) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}
inline RgbF rgb_255(const Rgb16& c) {
  return {static_cast<float>(c[0]) / 257.0f, static_cast<float>(c[1]) / 257.0f, static_cast<float>(c[2]) / 257.0f};
}
inline RgbF rgb_255(const RgbF& c) { return {c[0] * 255.0f, c[1] * 255.0f, c[2] * 255.0f}; }

/// That of point i. The cloud must have colors.
RgbF rgb_255(const Colors& colors, std::size_t i);

/// A color in units of 1/255, rounded; beyond 0..255 the end.
Rgb8 to_rgb8(const Eigen::Vector3f& rgb_255);

/// CIE L*a*b* (D65, 2 degrees) of an sRGB color in [0,1].
Eigen::Vector3d srgb_to_lab(const Eigen::Vector3d& rgb);

/// CIEDE2000 color difference with kL = kC = kH = 1 (Sharma, Wu, Dalal 2005, equations 2 to 22).
double delta_e_2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2);

/// Y, Cb, Cr of BT.709 from RGB in [0,1], with the four-digit coefficients of MPEG's pc_error; Y in [0,1], Cb and Cr
/// in [-0.5,0.5].
Eigen::Vector3d rgb_to_ycbcr709(const Eigen::Vector3d& rgb);

}  // namespace cmap
