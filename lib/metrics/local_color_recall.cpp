#include "cmap/metrics/local_color_recall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {
namespace {

constexpr int kCurvePoints = 15;
double curve_tau(int i) { return 0.02 * (i + 1); }

/// Largest squared color distance (1/255 units) that counts as right.
float color_limit(double tau) { return static_cast<float>((3.0 * tau * 255.0) * (3.0 * tau * 255.0)); }

float next_above(float v) { return std::nextafter(v, std::numeric_limits<float>::infinity()); }

RecallClass class_of(float sq_color, float right) {
  if (sq_color == kNoneWithin) return RecallClass::kNotCovered;
  return sq_color <= right ? RecallClass::kRecalled : RecallClass::kWrongColor;
}

struct RecallCounts {
  std::uint64_t n_covered = 0, n_recalled = 0;
  RecallCounts& operator+=(const RecallCounts& other) {
    n_covered += other.n_covered;
    n_recalled += other.n_recalled;
    return *this;
  }
};

/// Fills in the classes of all points and counts them.
RecallCounts classify(const Array<float>& best, float right, Array<RecallClass>& classes) {
  return ordered_sum<RecallCounts>(classes.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    RecallCounts counts;
    for (std::size_t j = begin; j < end; ++j) {
      classes[j] = class_of(best[j], right);
      counts.n_covered += classes[j] != RecallClass::kNotCovered ? 1 : 0;
      counts.n_recalled += classes[j] == RecallClass::kRecalled ? 1 : 0;
    }
    return counts;
  });
}

RecallCurve recall_curve(const Array<float>& best, std::size_t n) {
  RecallCurve curve;
  for (int i = 0; i < kCurvePoints; ++i) {
    std::uint64_t n_recalled = 0;
    const float right = color_limit(curve_tau(i));
    for (std::size_t j = 0; j < n; ++j) n_recalled += class_of(best[j], right) == RecallClass::kRecalled ? 1 : 0;
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

LocalColorRecall local_color_recall(const MapPair& pair, const LocalColorRecallOptions& options) {
  if (!pair.has_color()) throw std::invalid_argument("local_color_recall: both maps need colors");
  const float right = color_limit(options.tau);
  const float stop_at = options.curve ? std::min(right, color_limit(curve_tau(0))) : right;
  const float limit = options.curve ? std::max(right, color_limit(curve_tau(kCurvePoints - 1))) : right;
  const Array<float> best =
      most_similar_color(pair.estimate.index, pair.estimate.colors, pair.reference.index.points, pair.reference.colors,
                         pair.nearest_in_estimate, {options.radius_m, stop_at, next_above(limit)});

  LocalColorRecall recall;
  recall.n_reference = pair.reference.size();
  recall.classes.resize(recall.n_reference);
  const RecallCounts counts = classify(best, right, recall.classes);
  recall.n_covered = counts.n_covered;
  recall.n_recalled = counts.n_recalled;
  if (options.curve) recall.curve = recall_curve(best, recall.n_reference);
  return recall;
}

}  // namespace cmap
