#include <fmt/format.h>

#include <tuple>

#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"
#include "color/recall_levels.hpp"

namespace cmap {
namespace {

enum RecallColumn : std::size_t { kColored, kCovered, kRecalledColumn };

std::vector<double> values(const std::vector<Level>& levels) {
  std::vector<double> all;
  for (const Level& level : levels) all.push_back(level.value);
  return all;
}

Record map_record(const SkillMap& map) {
  std::vector<Record> rows;
  for (const SkillMap::Row& row : map.rows) {
    std::vector<double> floors, chances;
    for (const auto& [floor, chance] : row.levels) {
      floors.push_back(floor.value);
      chances.push_back(chance.value);
    }
    Record& record = rows.emplace_back();
    record.add("radius_m", row.radius_m).add("value", values(row.value)).add("floor", std::move(floors));
    record.add("chance", std::move(chances)).add("skill", values(row.skill));
  }
  return Record{}.add("tau", map.taus).add("n", map.n).add("per_radius", std::move(rows));
}

/// Where colors drawn at random are recalled nearly as often as points are covered, with where they would not be.
void warn_of_saturation(const Record& record, const Level& chance, const SkillMap& map,
                        std::vector<Warning>& warnings) {
  constexpr double kLeastCoverage = 0.1, kSaturated = 0.9;
  const double coverage = *record.number("coverage");
  if (!(coverage > kLeastCoverage && chance.value >= kSaturated * coverage)) return;
  double best = 0.0, radius_m = 0.0, tau = 0.0;
  for (const SkillMap::Row& row : map.rows) {
    for (std::size_t i = 0; i < row.skill.size(); ++i) {
      const bool is_better = row.skill[i].value > best && row.levels[i].chance.value < kSaturated * coverage;
      if (is_better) std::tie(best, radius_m, tau) = std::tuple(row.skill[i].value, row.radius_m, map.taus[i]);
    }
  }
  const std::string where =
      best > 0.0 ? fmt::format("skill is highest ({:.2g}) at --lcr-radius {:.3g} --lcr-tau {:.3g}", best, radius_m, tau)
                 : "no smaller radius or tau does better";
  warnings.push_back({"local_color_recall_saturated",
                      fmt::format("colors drawn at random would be recalled at {:.3g} of the reference's points, of "
                                  "{:.3g} that are covered: at this radius and tau LCR says little of colors; {}",
                                  chance.value, coverage, where)});
}

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
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>& warnings) {
          const MetricOptions& o = levels.inputs.options();
          const std::vector<double>& curve = levels.inputs.recall->curve.tau;
          std::vector<double> taus{o.lcr_tau};
          taus.insert(taus.end(), curve.begin(), curve.end());
          const std::vector<Levels> found = recall_levels(levels, o.lcr_radius_m, taus);
          add_levels_of(record, found.front(), "higher");
          if (!curve.empty()) {
            std::vector<double> chances;
            for (std::size_t i = 1; i < found.size(); ++i) chances.push_back(found[i].chance.value);
            record.part_to_change("curve").add("chance", std::move(chances));
          }
          const SkillMap map = skill_map(levels);
          record.add("skill_map", map_record(map));
          warn_of_saturation(record, found.front().chance, map, warnings);
        }};

}  // namespace catalog
}  // namespace cmap
