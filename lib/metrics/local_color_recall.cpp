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

/// Squared color distances of the covered reference points to the most similar estimated color within the radius,
/// exact above `stop_at`; nothing beyond `limit` is looked for. Points without cover are left at 0.
Array<float> best_color_distances(const MapPair& pair, double radius_m, float stop_at, float limit) {
  const NearestPairs pairs = pair.reference_to_estimate();
  Array<float> best(pairs.size());
  parallel_chunks(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto sq_color = static_cast<float>((pairs.from_color(i) - pairs.to_color(i)).squaredNorm());
      best[i] = pairs.distance_m(i) <= radius_m ? std::min(sq_color, next_above(limit)) : 0.0f;
    }
  });
  const IndexedMap& estimate = pair.estimate;
  lower_color_distance(estimate.index, estimate.colors, color_boxes(estimate.colors), pair.reference.index.points,
                       pair.reference.colors, {radius_m, stop_at}, best);
  return best;
}

RecallCurve recall_curve(const NearestPairs& pairs, const Array<float>& best, double radius_m) {
  RecallCurve curve;
  for (int i = 0; i < kCurvePoints; ++i) {
    std::uint64_t n_recalled = 0;
    for (std::size_t j = 0; j < pairs.size(); ++j) {
      n_recalled += pairs.distance_m(j) <= radius_m && best[j] <= color_limit(curve_tau(i)) ? 1 : 0;
    }
    curve.tau.push_back(curve_tau(i));
    curve.value.push_back(static_cast<double>(n_recalled) / static_cast<double>(pairs.size()));
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
  const Array<float> best = best_color_distances(pair, options.radius_m, stop_at, limit);

  const NearestPairs pairs = pair.reference_to_estimate();
  LocalColorRecall recall;
  recall.n_reference = pairs.size();
  recall.classes.resize(pairs.size());
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    const bool covered = pairs.distance_m(j) <= options.radius_m;
    const bool recalled = covered && best[j] <= right;
    recall.classes[j] = recalled  ? RecallClass::kRecalled
                        : covered ? RecallClass::kWrongColor
                                  : RecallClass::kNotCovered;
    recall.n_covered += covered ? 1 : 0;
    recall.n_recalled += recalled ? 1 : 0;
  }
  if (options.curve) recall.curve = recall_curve(pairs, best, options.radius_m);
  return recall;
}

}  // namespace cmap
