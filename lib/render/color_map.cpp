#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cmap/render/layer.hpp"
#include "names.hpp"

namespace cmap {
namespace {

std::array<Rgb8, 256> opencv_table(int opencv_map) {
  cv::Mat ramp(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) ramp.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat bgr;
  cv::applyColorMap(ramp, bgr, opencv_map);
  std::array<Rgb8, 256> table;
  for (int i = 0; i < 256; ++i) {
    const auto& c = bgr.at<cv::Vec3b>(0, i);
    table[static_cast<std::size_t>(i)] = {c[2], c[1], c[0]};
  }
  return table;
}

}  // namespace

ColorMap color_map_from_name(std::string_view name) {
  return value_of_name<ColorMap>("color map", name,
                                 {{"viridis", ColorMap::kViridis},
                                  {"cividis", ColorMap::kCividis},
                                  {"inferno", ColorMap::kInferno},
                                  {"turbo", ColorMap::kTurbo}});
}

const std::array<Rgb8, 256>& color_table(ColorMap map) {
  static const std::array<std::array<Rgb8, 256>, 4> tables{
      opencv_table(cv::COLORMAP_VIRIDIS), opencv_table(cv::COLORMAP_CIVIDIS), opencv_table(cv::COLORMAP_INFERNO),
      opencv_table(cv::COLORMAP_TURBO)};
  return tables[static_cast<std::size_t>(map)];
}

Rgb8 color_of(double value, const ColorScale& scale) {
  constexpr Rgb8 kNoValue{160, 160, 160};
  if (std::isnan(value)) return kNoValue;
  const auto position = [&](double v) { return scale.logarithmic ? std::log(v) : v; };
  const double low = position(scale.low), high = position(scale.high);
  // A logarithm of 0 is below every range.
  const double share = high > low ? (position(value) - low) / (high - low) : 0.0;
  const double entry = std::round(255.0 * std::fmin(std::fmax(share, 0.0), 1.0));
  return color_table(scale.map)[static_cast<std::size_t>(entry)];
}

}  // namespace cmap
