#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {
namespace {

constexpr int kCurvePoints = 15;
double curve_tau(int i) { return 0.02 * (i + 1); }

float next_above(float v) { return std::nextafter(v, std::numeric_limits<float>::infinity()); }

RecallClass class_of(float sq_color, float right) {
  if (sq_color == kNoneWithin) return RecallClass::kNotCovered;
  return sq_color <= right ? RecallClass::kRecalled : RecallClass::kWrongColor;
}

/// The colors, with a far one in place of those that are not there: boxes and comparisons need numbers.
Array<ColorBlock> without_gaps(Array<ColorBlock> colors, float far) {
  const auto fill = [&](float(&values)[kBlockSize]) {
    for (float& v : values) v = std::isnan(v) ? far : v;
  };
  for (ColorBlock& block : colors) {
    fill(block.r);
    fill(block.g);
    fill(block.b);
  }
  return colors;
}

/// The best color distance of every reference point.
Array<float> best_colors(const MapPair& pair, const ColorSearch& search) {
  const auto find = [&](const Array<ColorBlock>& reference, const Array<ColorBlock>& estimate) {
    return most_similar_color(pair.estimate.index, estimate, pair.reference.index.points, reference,
                              pair.nearest_in_estimate, search);
  };
  if (pair.reference.n_without_color + pair.estimate.n_without_color == 0) {
    return find(pair.reference.colors, pair.estimate.colors);
  }
  constexpr float kFar = 1e9f;  // on either side: no color is like another's missing one
  return find(without_gaps(pair.reference.colors, -kFar), without_gaps(pair.estimate.colors, kFar));
}

/// The classes of all points.
Array<RecallClass> classes_of(const IndexedMap& reference, const Array<float>& best, float right) {
  Array<RecallClass> classes(reference.size());
  parallel_chunks(classes.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      classes[j] = reference.has_color_at(j) ? class_of(best[j], right) : RecallClass::kNoColor;
    }
  });
  return classes;
}

/// `best` of all n reference points that have a color; those without are never recalled.
RecallCurve recall_curve(const Array<float>& best, std::uint64_t n) {
  RecallCurve curve;
  for (int i = 0; i < kCurvePoints; ++i) {
    std::uint64_t n_recalled = 0;
    const float right = right_color_limit(curve_tau(i));
    for (float sq_color : best) n_recalled += class_of(sq_color, right) == RecallClass::kRecalled ? 1 : 0;
    curve.tau.push_back(curve_tau(i));
    curve.value.push_back(static_cast<double>(n_recalled) / static_cast<double>(n));
  }
  for (std::size_t i = 1; i < curve.tau.size(); ++i) {
    curve.area += 0.5 * (curve.value[i] + curve.value[i - 1]) * (curve.tau[i] - curve.tau[i - 1]);
  }
  curve.area /= curve.tau.back() - curve.tau.front();
  return curve;
}

}  // namespace

float right_color_limit(double tau) {
  constexpr double kRounding = 1e-12;  // 3 x 0.2 is not 0.6 in double
  const double limit = 255.0 * (3.0 * tau + kRounding);
  const auto nearest = static_cast<float>(limit * limit);
  return static_cast<double>(nearest) <= limit * limit ? nearest : std::nextafter(nearest, 0.0f);
}

LocalColorRecall find_recall(const MapPair& pair, const LocalColorRecallOptions& options) {
  if (!pair.has_color()) throw std::invalid_argument("local color recall: both maps need colors");
  const float right = right_color_limit(options.tau);
  const float stop_at = options.curve ? std::min(right, right_color_limit(curve_tau(0))) : right;
  const float limit = options.curve ? std::max(right, right_color_limit(curve_tau(kCurvePoints - 1))) : right;
  const Array<float> best = best_colors(pair, {options.radius_m, stop_at, next_above(limit), options.radius_steps});

  LocalColorRecall recall;
  recall.classes = classes_of(pair.reference, best, right);
  if (options.curve) recall.curve = recall_curve(best, pair.reference.size() - pair.reference.n_without_color);
  return recall;
}

}  // namespace cmap
