#include "cmap/metrics/color_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/core/color.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/metrics/order_statistics.hpp"
#include "metrics/counted_sum.hpp"

namespace cmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void require_colors(const IndexedMap& a, const IndexedMap& b) {
  if (!a.has_color() || !b.has_color()) throw std::invalid_argument("color metric: both maps need colors");
}

DirectedColorDistance directed_distance(const NearestPairs& pairs, const ColorDistanceOptions& options,
                                        const Eigen::Vector3d& from_gain, const Eigen::Vector3d& to_gain) {
  const auto total = ordered_sum<CountedSum>(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    CountedSum part;
    for (std::size_t i = begin; i < end; ++i) {
      if (pairs.is_within(i, options.min_distance_m) || !pairs.is_within(i, options.max_distance_m)) continue;
      if (!pairs.has_colors(i)) continue;
      part.sum += pairs.color_difference(i, from_gain, to_gain).norm();
      ++part.n;
    }
    return part;
  });
  return {total.sum / (255.0 * static_cast<double>(total.n)), total.n, pairs.size() - total.n};
}

struct VectorSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::uint64_t n = 0;
  VectorSum& operator+=(const VectorSum& other) {
    sum += other.sum;
    n += other.n;
    return *this;
  }
};

Eigen::Vector3d mean_sq_ycbcr(const NearestPairs& pairs) {
  const auto total = ordered_sum<VectorSum>(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    VectorSum part;
    for (std::size_t i = begin; i < end; ++i) {
      if (!pairs.has_colors(i)) continue;
      ++part.n;
      // The transform is linear: that of the difference is the difference of both.
      part.sum += rgb_to_ycbcr709((pairs.from_color(i) - pairs.to_color(i)) / 255.0).cwiseAbs2();
    }
    return part;
  });
  return total.sum / static_cast<double>(total.n);
}

}  // namespace

ColorDistance color_distance(const MapPair& pair, const ColorDistanceOptions& options) {
  require_colors(pair.reference, pair.estimate);
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  return {directed_distance(pair.estimate_to_reference(), options, options.estimate_gain, one),
          directed_distance(pair.reference_to_estimate(), options, one, options.estimate_gain)};
}

double color_fidelity_db(double color_distance) { return -20.0 * std::log10(color_distance); }

ExposureGains exposure_gains(const MapPair& pair, double max_distance_m) {
  require_colors(pair.reference, pair.estimate);
  const NearestPairs pairs = pair.estimate_to_reference();
  ExposureGains gains{Eigen::Vector3d::Constant(kNone), 0};
  std::array<std::vector<double>, 3> ratios;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs.is_within(i, max_distance_m) || !pairs.has_colors(i)) continue;
    ++gains.n_pairs;
    const Eigen::Vector3d estimate = pairs.from_color(i);
    const Eigen::Vector3d reference = pairs.to_color(i);
    for (int c = 0; c < 3; ++c) {
      if (estimate[c] != 0.0 && reference[c] != 0.0)
        ratios[static_cast<std::size_t>(c)].push_back(reference[c] / estimate[c]);
    }
  }
  for (int c = 0; c < 3; ++c) {
    gains.gain[c] = quantiles(ratios[static_cast<std::size_t>(c)], std::array{0.5}).front();
  }
  return gains;
}

ColorPsnr color_psnr(const MapPair& pair) {
  require_colors(pair.reference, pair.estimate);
  return {mean_sq_ycbcr(pair.estimate_to_reference()), mean_sq_ycbcr(pair.reference_to_estimate())};
}

Eigen::Vector3d ColorPsnr::psnr_db() const {
  constexpr double kNoise = 1e-24;  // what rounding leaves of a channel without any difference
  return mse_estimate_to_reference.binaryExpr(mse_reference_to_estimate, [](double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return kNone;
    const double mse = std::max(a, b);
    return mse < kNoise ? std::numeric_limits<double>::infinity() : -10.0 * std::log10(mse);
  });
}

double delta_e(const NearestPairs& pairs, std::size_t slot) {
  return delta_e_2000(srgb_to_lab(pairs.from_color(slot) / 255.0), srgb_to_lab(pairs.to_color(slot) / 255.0));
}

DeltaEStats delta_e(const NearestPairs& pairs, double max_distance_m) {
  require_colors(pairs.from, pairs.to);
  std::vector<double> values(pairs.size(), kNone);
  parallel_chunks(pairs.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (pairs.is_within(i, max_distance_m) && pairs.has_colors(i)) values[i] = delta_e(pairs, i);
    }
  });
  std::erase_if(values, [](double v) { return std::isnan(v); });
  const auto total = ordered_sum<CountedSum>(values.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    CountedSum part;
    for (std::size_t i = begin; i < end; ++i) part += {values[i], 1};
    return part;
  });
  const std::vector<double> ranked = quantiles(values, std::array{0.5, 0.95});
  return {total.sum / static_cast<double>(total.n), ranked[0], ranked[1], total.n};
}

}  // namespace cmap
