#include <numbers>

#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "color/color_distance.hpp"
#include "color/color_fields.hpp"
#include "color/color_levels.hpp"

namespace cmap::catalog {

extern constinit const Metric color_fidelity{
    .info = {.id = "color_fidelity",
             .symbol = "CF",
             .title = "color fidelity",
             .group = "color",
             .unit = "dB",
             .better = "higher",
             .definition = "-20 log10 of the color distance: the color distance in decibels.",
             .needs_color = true},
    .sums_of = &color_distance,
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          return Record{.value = -20.0 * std::log10(mean_color_distance(sums)),
                        .parameters = {max_distance_parameter(settings.options)}};
        },
    .finish =
        [](Record& record, const MetricInputs&, std::span<const double>, std::vector<Warning>& warnings) {
          warn_of_no_pairs(record, warnings);
          if (!std::isinf(*record.value)) return;
          warnings.push_back(
              {"color_fidelity_infinite", "every color is exact: color fidelity is infinite, which is null in JSON"});
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          const auto in_decibels = [](Level level) {
            level.se *= 20.0 / std::numbers::ln10 / level.value;
            level.value = -20.0 * std::log10(level.value);
            return level;
          };
          Levels found = color_distance_levels(levels);
          found.floor = in_decibels(found.floor);
          found.chance = in_decibels(found.chance);
          add_levels_of(record, found, "higher");
        }};

}  // namespace cmap::catalog
