#include "cmap/recon/overlap_scale.hpp"

#include <cmath>
#include <stdexcept>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

float median_of_finite(std::span<const float> values) {
  std::vector<float> finite;
  for (const float v : values) {
    if (std::isfinite(v)) finite.push_back(v);
  }
  return finite.empty() ? INFINITY : median(finite);
}

bool is_depth(float depth) { return std::isfinite(depth) && depth > 0.0f; }

void append_log_ratios(const SharedFrame& frame, std::vector<double>& log_ratios) {
  const std::size_t n = frame.depth_before.size();
  if (frame.confidence_before.size() != n || frame.depth_after.size() != n || frame.confidence_after.size() != n) {
    throw std::invalid_argument("scale_ratio_of_depths: the two sessions must have equally many pixels");
  }
  const float least_before = median_of_finite(frame.confidence_before);
  const float least_after = median_of_finite(frame.confidence_after);
  for (std::size_t i = 0; i < n; ++i) {
    if (!(frame.confidence_before[i] >= least_before && frame.confidence_after[i] >= least_after)) continue;
    if (!is_depth(frame.depth_before[i]) || !is_depth(frame.depth_after[i])) continue;
    log_ratios.push_back(
        std::log(static_cast<double>(frame.depth_before[i]) / static_cast<double>(frame.depth_after[i])));
  }
}

}  // namespace

std::optional<ScaleRatio> scale_ratio_of_depths(std::span<const SharedFrame> frames, int min_pixels) {
  std::vector<double> log_ratios;
  for (const SharedFrame& frame : frames) append_log_ratios(frame, log_ratios);
  if (log_ratios.empty() || std::ssize(log_ratios) < min_pixels) return std::nullopt;
  const double log_ratio = median(log_ratios);
  return ScaleRatio{std::exp(log_ratio), robust_sigma(log_ratios, log_ratio), log_ratios.size()};
}

std::optional<ScaleRatio> scale_ratio_of_centers(std::span<const Eigen::Vector3d> centers_before,
                                                 std::span<const Eigen::Vector3d> centers_after) {
  if (centers_before.size() != centers_after.size()) {
    throw std::invalid_argument("scale_ratio_of_centers: equally many camera centers expected");
  }
  const std::size_t n = centers_after.size();
  const PairMoments moments = pair_moments(n, [&](std::size_t i) {
    return WeightedPair{centers_after[i], centers_before[i], 1.0};
  });
  try {
    const Similarity T = fit_similarity(moments, ScaleModel::free());
    if (!(T.scale > 0.0)) return std::nullopt;
    const double cost = std::max(0.0, similarity_cost(moments, ScaleModel::free(), T));
    const double sq_sigma = cost / (3.0 * static_cast<double>(n) - 7.0) / moments.scatter_p.trace();
    return ScaleRatio{T.scale, std::sqrt(sq_sigma) / T.scale, n};
  } catch (const UnsupportedError&) {
    return std::nullopt;
  }
}

}  // namespace cmap
