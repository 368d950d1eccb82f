#include "sensors/depth_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "cmap/sim/random_stream.hpp"

namespace cmap {
namespace {

/// A smooth random field over the image, unit standard deviation, drawn once per session: its waves travel on from
/// frame to frame, as a network's errors about one and the same thing do.
class SmoothField {
 public:
  SmoothField(const ErrorDraw& draw, double shortest_px) {
    RandomStream random(draw.seed, draw.field_purpose, draw.session);
    for (Wave& wave : waves_) {
      const double rate = 2.0 * std::numbers::pi / (shortest_px * random.uniform(1.0, 3.0));
      const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double per_frame = random.uniform(-0.3, 0.3);
      wave = {rate * std::cos(direction), rate * std::sin(direction),
              random.uniform(0.0, 2.0 * std::numbers::pi) + per_frame * static_cast<double>(draw.frame)};
    }
  }
  double at(double u, double v) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::cos(wave.u * u + wave.v * v + wave.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));  // a cosine has the variance 1/2
  }

 private:
  struct Wave {
    double u, v, phase;
  };
  std::array<Wave, 6> waves_;
};

/// Nearest and farthest depth of a pixel and its four neighbors.
struct DepthSpan {
  double near, far;
};

DepthSpan span_around(const Array<float>& depth, int width, int height, int u, int v, double sky_m) {
  DepthSpan span{sky_m, 0.0};
  const auto include = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const double d = std::min(
        sky_m, static_cast<double>(
                   depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]));
    span = {std::min(span.near, d), std::max(span.far, d)};
  };
  include(u, v);
  include(u - 1, v);
  include(u + 1, v);
  include(u, v - 1);
  include(u, v + 1);
  return span;
}

struct Prediction {
  double depth_m, confidence;
};

Prediction predict(double true_m, const DepthSpan& span, double field, const PredictionOptions& o,
                   RandomStream random) {
  const double bias = o.depth_bias_fraction * std::min(1.0, true_m / o.depth_bias_range_m);
  double depth = true_m * std::exp(o.depth_noise_fraction * random.normal() + bias * field);
  double expected = true_m * std::hypot(o.depth_noise_fraction, bias);
  if (o.floater_fraction > 0.0 && span.far > span.near * (1.0 + o.edge_fraction)) {
    if (random.uniform() < o.floater_fraction) depth = span.near * std::pow(span.far / span.near, random.uniform());
    expected = std::hypot(expected, o.floater_fraction * (span.far - span.near) / 3.0);
  }
  const double error = std::abs(depth - true_m);
  const double belief = std::pow(error, o.confidence_insight) * std::pow(expected, 1.0 - o.confidence_insight) *
                        std::exp(o.confidence_noise * random.normal());
  return {depth, 1.0 + (o.confidence_peak - 1.0) / (1.0 + belief / o.confidence_half_error_m)};
}

}  // namespace

PredictedDepth with_depth_errors(const Array<float>& true_depth_m, int width, int height, const PredictionOptions& o,
                                 const ErrorDraw& draw) {
  const SmoothField field(draw, o.depth_bias_size_px);
  // A seed of this frame's own, so that the pixel is the item.
  const std::uint64_t pixel_seed =
      RandomStream(draw.seed, draw.pixel_purpose, draw.session * 1'000'000 + draw.frame).bits();
  PredictedDepth predicted{Array<float>(true_depth_m.size()), Array<float>(true_depth_m.size())};
  const auto row_pixels = static_cast<std::size_t>(width);
  parallel_chunks(true_depth_m.size(), 16 * row_pixels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int u = static_cast<int>(i % row_pixels), v = static_cast<int>(i / row_pixels);
      Prediction p{o.sky_depth_m, 1.0};
      if (true_depth_m[i] <= o.max_depth_m) {
        p = predict(true_depth_m[i], span_around(true_depth_m, width, height, u, v, o.sky_depth_m), field.at(u, v), o,
                    RandomStream(pixel_seed, draw.pixel_purpose, i));
      }
      predicted.depth_m[i] = static_cast<float>(p.depth_m);
      predicted.confidence[i] = static_cast<float>(p.confidence);
    }
  });
  return predicted;
}

}  // namespace cmap
