#include "clouds/color_plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cmap/geometry/color.hpp"

namespace cmap {
namespace {

// Points looked at, evenly spread over the file: enough for shares of a percent, nothing beside reading.
constexpr std::size_t kSample = 1 << 14;
constexpr double kLargeShare = 0.2;   // of one color
constexpr double kMixedShare = 0.05;  // of colors on another scale than the rest
constexpr double kNearlyAll = 0.99;
constexpr std::uint64_t kFewPoints = 20;  // in which a color may repeat by chance

std::vector<RgbF> sample_of(const Colors& colors, std::size_t size) {
  std::vector<RgbF> sample;
  const std::size_t n = std::min(size, kSample);
  for (std::size_t i = 0; i < n; ++i) {
    const RgbF color = rgb_255(colors, i * size / n);
    if (!std::isnan(color[0])) sample.push_back(color);
  }
  return sample;
}

std::uint64_t count_of(const Colors& colors, std::size_t size, const RgbF& wanted) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < size; ++i) n += rgb_255(colors, i) == wanted ? 1 : 0;
  return n;
}

/// The most frequent color, and how often it is there. Sorts the sample.
std::pair<RgbF, std::size_t> most_frequent(std::vector<RgbF>& sample) {
  std::sort(sample.begin(), sample.end());
  std::pair<RgbF, std::size_t> most{{}, 0};
  for (auto begin = sample.begin(); begin != sample.end();) {
    const auto end = std::upper_bound(begin, sample.end(), *begin);
    const auto n = static_cast<std::size_t>(end - begin);
    if (n > most.second) most = {*begin, n};
    begin = end;
  }
  return most;
}

void warn_of_one_color(const Colors& colors, std::size_t size, std::vector<RgbF>& sample, FileInfo& info) {
  const auto [color, n_sampled] = most_frequent(sample);
  if (static_cast<double>(n_sampled) < kLargeShare * static_cast<double>(sample.size())) return;
  const std::uint64_t n = count_of(colors, size, color);
  if (n < kFewPoints || static_cast<double>(n) < kLargeShare * static_cast<double>(size)) return;
  const std::string share = n == size
                                ? "all points have one and the same color"
                                : fmt::format("{:.3g} % of the points ({} of {}) have exactly the same color",
                                              100.0 * static_cast<double>(n) / static_cast<double>(size), n, size);
  const std::string_view name = color == RgbF{0, 0, 0} ? " (black)" : color == RgbF{255, 255, 255} ? " (white)" : "";
  info.warnings.push_back(
      {"one_color", fmt::format("{}, {:.4g} {:.4g} {:.4g} of 255{}: a placeholder for points that were never seen by a "
                                "camera?",
                                share, color[0], color[1], color[2], name)});
}

float brightest(const RgbF& color) { return std::max({color[0], color[1], color[2]}); }

/// Share of the colors that are not black which are no brighter than `limit` (in 1/255), as if on another scale: next
/// to none is between it and its double, where a scene's dark colors would go on. 0 where there are few.
double share_below(const std::vector<RgbF>& sample, float limit) {
  constexpr double kGap = 0.1;  // of as many
  std::size_t n = 0, n_below = 0, n_next = 0;
  for (const RgbF& color : sample) {
    const float bright = brightest(color);
    n += bright > 0.0F ? 1 : 0;
    n_below += bright > 0.0F && bright <= limit ? 1 : 0;
    n_next += bright > limit && bright <= 2.0F * limit ? 1 : 0;
  }
  if (n_below < kFewPoints || static_cast<double>(n_next) > kGap * static_cast<double>(n_below)) return 0.0;
  return static_cast<double>(n_below) / static_cast<double>(n);
}

struct Range {
  float white;                       ///< the number that stands for white
  float below;                       ///< the white of the next smaller scale
  float small_share;                 ///< of white: below, no scene is that dark
  double mixed_share = kMixedShare;  ///< of colors on the next smaller scale: more are no dark parts of a scene
};

Range range_of(const Colors& colors, const StoredColors& stored) {
  constexpr float kEighth = 0.126F, kQuarter = 0.251F;  // a quarter: cameras of 14 bits in fields of 16
  if (std::holds_alternative<Array<Rgb16>>(colors)) return {65535.0F, 255.0F, kQuarter};
  if (std::holds_alternative<Array<Rgb8>>(colors)) return {255.0F, 1.0F, kEighth, kNearlyAll};
  return {stored.white, stored.white > 255.0F ? 255.0F : stored.white > 1.0F ? 1.0F : 0.0F, kEighth};
}

void warn_of_dark_colors(const Colors& colors, const StoredColors& stored, const std::vector<RgbF>& sample,
                         FileInfo& info) {
  const Range range = range_of(colors, stored);
  if (stored.highest <= range.small_share * range.white) {
    info.warnings.push_back(
        {"dark_colors",
         fmt::format("the highest color value is {:g} of {:g}: are the colors on another scale (10 or 12 "
                     "bits, or cut to 0 and 1)?",
                     stored.highest, range.white)});
    return;
  }
  const double share = range.below > 0.0F ? share_below(sample, 255.0F * range.below / range.white) : 0.0;
  if (share < range.mixed_share) return;
  info.warnings.push_back(
      {"dark_colors",
       fmt::format("{:.3g} % of the colors that are not black are at most {:g}, but the highest value is {:g}, so that "
                   "{:g} was taken for white: are some points on another scale than the rest?",
                   100.0 * share, range.below, stored.highest, range.white)});
}

/// 8-bit colors shifted up by 7 bits, as by cameras and writers that keep a bit for the sign.
void warn_of_fifteen_bits(const Colors& colors, const StoredColors& stored, FileInfo& info) {
  constexpr std::uint32_t kShifted = 0xffU << 7;
  const bool shifted = (stored.bits & ~kShifted) == 0 && (stored.bits & (kShifted & ~0xff00U)) != 0;
  if (!std::holds_alternative<Array<Rgb16>>(colors) || !shifted) return;
  info.warnings.push_back(
      {"dark_colors",
       fmt::format("all color values are multiples of 128 and the highest is {:g}, though 65535 was taken for white: "
                   "are they 8-bit colors times 128? Then half of every color is missing",
                   stored.highest)});
}

}  // namespace

std::string color_scale_text(const Colors& colors, float white, const ColorDeclaration& declaration) {
  if (std::holds_alternative<Array<Rgb16>>(colors)) return "16 bit";
  if (std::holds_alternative<Array<RgbF>>(colors)) {
    return white == 1.0F ? "0 to 1" : white == 255.0F ? "0 to 255, with fractions" : "0 to 65535, with fractions";
  }
  return declaration.type == ScalarType::kUint16 ? "8-bit values in 16-bit fields" : "0 to 255";
}

std::string color_scale_note(const Colors& colors, float white, const ColorDeclaration& declaration) {
  const bool packed = declaration.storage == ColorStorage::kPacked;
  const auto declared = declaration.type;
  if (std::holds_alternative<Array<Rgb8>>(colors)) {
    if (packed || declared == ScalarType::kUint8) return "";
    if (declared == ScalarType::kUint16) return "8-bit colors in 16-bit fields";
    return "colors taken as 0 to 255: values above 1";
  }
  if (std::holds_alternative<Array<Rgb16>>(colors)) {
    return declared == ScalarType::kUint16 ? "" : "colors taken as 0 to 65535: values above 255";
  }
  if (white == 1.0F) return declared ? "" : "colors taken as [0,1]: no value above 1";
  if (packed) return "";
  return fmt::format("colors taken as 0 to {:g}, with fractions: values above {:g}", white,
                     white > 255.0F ? 255.0F : 1.0F);
}

void warn_of_odd_colors(const Colors& colors, const StoredColors& stored, FileInfo& info) {
  const std::size_t size = std::visit(
      []<class T>(const T& c) -> std::size_t {
        if constexpr (std::is_same_v<T, std::monostate>)
          return 0;
        else
          return c.size();
      },
      colors);
  std::vector<RgbF> sample = sample_of(colors, size);
  if (sample.empty()) return;
  info.gray_colors =
      std::all_of(sample.begin(), sample.end(), [](const RgbF& c) { return c[0] == c[1] && c[1] == c[2]; });
  warn_of_dark_colors(colors, stored, sample, info);
  warn_of_fifteen_bits(colors, stored, info);
  warn_of_one_color(colors, size, sample, info);
}

}  // namespace cmap
