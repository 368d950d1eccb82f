#include "cmap/geometry/color.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

constexpr std::size_t kLumaPairs = 3;  // after the squares of Y, Cb and Cr

/// Mean squared Y, Cb, Cr differences (BT.709, unit range) of one side's pairs.
std::vector<double> mean_squares(std::span<const double> sums) {
  const double n = sums[kLumaPairs];
  return {sums[0] / n, sums[1] / n, sums[2] / n};
}

/// 10 log10(1 / mse) of the worse direction; infinite where both are rounding noise, NaN where one has no pairs.
double worse_psnr_db(double mse_a, double mse_b) {
  constexpr double kNoise = 1e-24;  // what rounding leaves of a channel without any difference
  if (std::isnan(mse_a) || std::isnan(mse_b)) return NAN;
  const double mse = std::max(mse_a, mse_b);
  return mse < kNoise ? INFINITY : -10.0 * std::log10(mse);
}

}  // namespace

namespace catalog {

extern constinit const Metric color_psnr{
    .info = {.id = "color_psnr",
             .symbol = "PSNR",
             .title = "color PSNR",
             .group = "color+",
             .unit = "dB",
             .better = "higher",
             .definition = "Peak signal-to-noise ratio of nearest pairs in Y (and Cb, Cr), BT.709, the worse of both "
                           "directions, as MPEG's pc_error.",
             .needs_color = true},
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"sq_y", "sq_cb", "sq_cr", "n"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          const NearestPairs pairs = run.inputs.pairs(run.side);
          for (std::size_t slot = run.begin; slot < run.begin + run.size; ++slot) {
            if (!pairs.has_colors(slot)) continue;
            // The transform is linear: that of the difference is the difference of both.
            const Eigen::Vector3d difference = rgb_to_ycbcr709((pairs.from_color(slot) - pairs.to_color(slot)) / 255.0);
            for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)].add(difference[c] * difference[c]);
            sums[kLumaPairs].add(1.0);
          }
        },
    .value =
        [](const PairSums& sums, const MetricSettings&) {
          const std::vector<double> e = mean_squares(sums.estimate), r = mean_squares(sums.reference);
          Record record{.value = worse_psnr_db(e[0], r[0])};
          record.add("y", worse_psnr_db(e[0], r[0]))
              .add("cb", worse_psnr_db(e[1], r[1]))
              .add("cr", worse_psnr_db(e[2], r[2]));
          return record.add("mse", Record{}.add("estimate_to_reference", e).add("reference_to_estimate", r));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          if (std::isinf(*record.value)) {
            warnings.push_back({"color_psnr_infinite", "luma is exact: color PSNR is infinite, which is null in JSON"});
          }
          add_without_color(record, inputs);
        }};

}  // namespace catalog
}  // namespace cmap
