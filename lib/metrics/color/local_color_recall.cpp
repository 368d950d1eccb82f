#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

enum RecallColumn : std::size_t { kColored, kCovered, kRecalledColumn };

}  // namespace

namespace catalog {

extern constinit const Metric local_color_recall{
    .info = {.id = "local_color_recall",
             .symbol = "LCR",
             .title = "local color recall",
             .group = "color",
             .unit = "1",
             .better = "higher",
             .definition = "Share of reference points with an estimated point within the radius whose color differs by "
                           "at most 3 tau. Never above the coverage, the share with any estimated point there.",
             .needs_color = true,
             .share = true,
             .paper_factor = 100.0,
             .paper_unit = "%"},
    .prepare =
        [](MetricInputs& inputs) {
          const MetricOptions& o = inputs.options();
          inputs.recall =
              find_recall(*inputs.pair, {.tau = o.lcr_tau, .radius_m = o.lcr_radius_m, .curve = o.lcr_curve});
        },
    .sides = Sides::kReference,
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"colored", "covered", "recalled"};
        },
    .add =
        [](const PointRun& run, std::span<ExactSum> sums) {
          std::uint64_t n_colored = 0, n_covered = 0, n_recalled = 0;
          for (std::size_t slot = run.begin; slot < run.begin + run.size; ++slot) {
            const RecallClass found = run.inputs.recall->classes[slot];
            n_colored += found != RecallClass::kNoColor ? 1 : 0;
            n_covered += found == RecallClass::kRecalled || found == RecallClass::kWrongColor ? 1 : 0;
            n_recalled += found == RecallClass::kRecalled ? 1 : 0;
          }
          sums[kColored].add(static_cast<double>(n_colored));
          sums[kCovered].add(static_cast<double>(n_covered));
          sums[kRecalledColumn].add(static_cast<double>(n_recalled));
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const double n = sums.reference[kColored], covered = sums.reference[kCovered],
                       recalled = sums.reference[kRecalledColumn];
          Record record{.value = recalled / n,
                        .parameters = {{"tau", settings.options.lcr_tau}, {"radius_m", settings.options.lcr_radius_m}}};
          record.add("coverage", covered / n).add("conditional", recalled / covered);
          record.add("n_reference", static_cast<std::uint64_t>(n))
              .add("n_covered", static_cast<std::uint64_t>(covered));
          return record.add("n_recalled", static_cast<std::uint64_t>(recalled));
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>&) {
          add_without_color(record, inputs);
          const RecallCurve& curve = inputs.recall->curve;
          if (curve.tau.empty()) return;
          record.add("curve", Record{}.add("tau", curve.tau).add("value", curve.value).add("area", curve.area));
        }};

}  // namespace catalog
}  // namespace cmap
