#pragma once

#include <vector>

#include "io/capture_testing.hpp"

namespace cmap::testing {

/// Point i at (i, 2 i + 0.5, -i), and colors of its own, no two equal.
inline Eigen::Vector3d sample_point(std::size_t i) {
  const auto t = static_cast<double>(i);
  return {t, 2 * t + 0.5, -t};
}
inline Rgb8 sample_color(std::size_t i) {
  return {static_cast<U8>(10 * i + 200), static_cast<U8>(40 + i), static_cast<U8>(255 - 7 * i)};
}

template <class T>
std::string point_bytes(std::size_t n) {
  std::vector<T> values;
  for (std::size_t i = 0; i < n; ++i) {
    for (const double value : sample_point(i)) values.push_back(static_cast<T>(value));
  }
  return raw(values);
}

template <class T>
std::string color_bytes(std::size_t n, double scale = 1.0) {
  std::vector<T> values;
  for (std::size_t i = 0; i < n; ++i) {
    for (const U8 value : sample_color(i)) values.push_back(static_cast<T>(scale * value));
  }
  return raw(values);
}

inline RgbF fraction(const Colors& colors, std::size_t i) {
  if (const auto* bytes = std::get_if<Array<Rgb8>>(&colors)) {
    const auto& c = (*bytes)[i];
    return {static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255, static_cast<float>(c[2]) / 255};
  }
  if (const auto* shorts = std::get_if<Array<Rgb16>>(&colors)) {
    const auto& c = (*shorts)[i];
    return {static_cast<float>(c[0]) / 65535, static_cast<float>(c[1]) / 65535, static_cast<float>(c[2]) / 65535};
  }
  return std::get<Array<RgbF>>(colors)[i];
}

/// The first n sample points, in order; `stride` of them apart where only every so many-th is there.
inline void expect_samples(const PointCloudFile& file, std::size_t n, bool colored, std::size_t stride = 1) {
  ASSERT_EQ(file.cloud.size(), n);
  ASSERT_EQ(file.cloud.has_color(), colored);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(point(file, i), sample_point(i * stride)) << i;
    if (!colored) continue;
    const Rgb8 expected = sample_color(i * stride);
    const RgbF actual = fraction(file.cloud.colors, i);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k] / 255.0, 1e-6) << i << " " << k;
  }
}

}  // namespace cmap::testing
