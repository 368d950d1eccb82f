#include <fmt/format.h>

#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric.hpp"
#include "color/color_fields.hpp"

namespace cmap {
namespace {

enum ConsistencyColumn : std::size_t { kOccupied, kEnough, kSingle, kOnePlace, kTrace, kTraceOfEnough, kColumns };

std::uint64_t counted(std::span<const double> sums, ConsistencyColumn column) {
  return static_cast<std::uint64_t>(sums[column]);
}

Record consistency_of(std::span<const double> sums, Singletons singletons) {
  const bool excluded = singletons == Singletons::kExclude;
  const double zero = sums[kTrace] / sums[kOccupied], exclude = sums[kTraceOfEnough] / sums[kEnough];
  Record record{.value = excluded ? exclude : zero};
  record.add("value_x100", 100.0 * *record.value).add("zero", zero).add("exclude", exclude);
  record.add("n_voxels", counted(sums, excluded ? kEnough : kOccupied)).add("n_occupied", counted(sums, kOccupied));
  return record.add("n_singletons", counted(sums, kSingle));
}

/// What does not follow from the sums of one map.
void add_rest(Record& record, const ColorConsistency& found, const IndexedMap& map) {
  record.add("median", found.median);
  if (map.n_without_color > 0) record.add("n_without_color", map.n_without_color);
}

void refuse_singletons(const MetricOptions& o, const ColorConsistency& found) {
  if (o.ccs_singletons != Singletons::kRefuse || found.n_singletons.value() == 0.0) return;
  throw UnsupportedError(fmt::format(
      "ccs-singletons: {} of the evaluated map's {} voxels of {} m hold a single point; zero or exclude says "
      "what they count as",
      found.n_singletons.value(), found.n_occupied.value(), o.ccs_voxel_m));
}

/// Copies of a point do not make a voxel any less a single one.
void warn_of_singletons(const MetricOptions& o, const ColorConsistency& found, std::vector<Warning>& warnings) {
  const double n_single = found.n_singletons.value() + found.n_one_place.value();
  if (2.0 * n_single <= found.n_occupied.value()) return;
  const char* counted = o.ccs_singletons == Singletons::kExclude ? "color consistency is of the rest alone"
                                                                 : "they count as 0, which is perfect";
  warnings.push_back(
      {"color_consistency_sparse",
       fmt::format("{} of the evaluated map's {} voxels of {} m hold a single point or copies of one: {}; a larger "
                   "ccs-voxel says more of so sparse a map",
                   n_single, found.n_occupied.value(), o.ccs_voxel_m, counted)});
}

/// The reference's own value over voxels of enough points.
Level own_level(const ColorConsistency& reference) {
  const double n = reference.n_enough.value(), sum = reference.trace_of_enough.value();
  if (n == 0.0) return {.reason = "no voxel of the reference holds enough points"};
  const double sq_sum = reference.sq_trace_of_enough.value();
  const double variance = n < 2.0 ? NAN : std::max(0.0, sq_sum - sum * sum / n) / (n - 1.0);
  return {sum / n, std::sqrt(variance / n), static_cast<std::uint64_t>(n)};
}

/// The trace of the covariance of all colors.
Level chance_level(const std::vector<Eigen::Vector3d>& colors) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& color : colors) mean += color / static_cast<double>(colors.size());
  std::vector<double> squares;
  for (const Eigen::Vector3d& color : colors) squares.push_back((color - mean).squaredNorm() / (255.0 * 255.0));
  const auto n = static_cast<double>(colors.size());
  return scaled(mean_level(squares), n / (n - 1.0));
}

std::array<double, kColumns> terms_of(const VoxelColors& voxel, std::uint64_t min_points) {
  const bool single = voxel.n == 1, enough = !single && voxel.n >= min_points;
  return {1.0,         enough ? 1.0 : 0.0,        single ? 1.0 : 0.0, !single && voxel.one_place ? 1.0 : 0.0,
          voxel.trace, enough ? voxel.trace : 0.0};
}

}  // namespace

namespace catalog {

extern constinit const Metric color_consistency{
    .info = {.id = "color_consistency",
             .symbol = "CCS",
             .title = "color consistency",
             .group = "color",
             .unit = "unit RGB^2",
             .better = "lower",
             .definition =
                 "Mean over the estimate's voxels of the trace of the color covariance: how much colors scatter "
                 "within a voxel. One of a single point counts as 0 or is left out, as the parameters say.",
             .needs_color = true,
             .needs_reference = false,
             .paper_factor = 100.0,
             .paper_unit = "unit RGB^2 x 100"},
    .prepare =
        [](MetricInputs& inputs) {
          const MetricOptions& o = inputs.options();
          for (const Side side : inputs.sides()) {
            inputs.color_consistency.of(side) =
                cmap::color_consistency(inputs.map(side), o.ccs_voxel_m, o.ccs_min_points);
          }
          if (o.ccs_phases) inputs.consistency_phases = color_consistency_phases(inputs.estimate, o);
        },
    .columns =
        [](const MetricSettings&) {
          return std::vector<std::string>{"occupied", "enough", "single", "one_place", "trace", "trace_of_enough"};
        },
    .each_voxel =
        [](const MetricInputs& inputs, Side side, const std::function<void(const VoxelTerms&)>& use) {
          const MetricOptions& o = inputs.options();
          for (const VoxelColors& voxel : voxel_colors(inputs.map(side), o.ccs_voxel_m)) {
            const std::array<double, kColumns> terms = terms_of(voxel, o.ccs_min_points);
            use({voxel.index, o.ccs_voxel_m, terms});
          }
        },
    .add_voxels =
        [](const MetricInputs& inputs, Side side, std::span<ExactSum> sums) {
          const ColorConsistency& found = *inputs.color_consistency.of(side);
          const ExactSum* const in_columns[kColumns]{&found.n_occupied,  &found.n_enough, &found.n_singletons,
                                                     &found.n_one_place, &found.trace,    &found.trace_of_enough};
          for (std::size_t column = 0; column < kColumns; ++column) sums[column] += *in_columns[column];
        },
    .value =
        [](const PairSums& sums, const MetricSettings& settings) {
          const MetricOptions& o = settings.options;
          Record record = consistency_of(sums.estimate, o.ccs_singletons);
          record.parameters = {{"voxel_m", o.ccs_voxel_m},
                               {"singletons", std::string(name_of(o.ccs_singletons, singletons_names()))},
                               {"min_points", o.ccs_min_points}};
          if (!sums.reference.empty()) record.add("reference", consistency_of(sums.reference, o.ccs_singletons));
          return record;
        },
    .finish =
        [](Record& record, const MetricInputs& inputs, std::span<const double>, std::vector<Warning>& warnings) {
          const MetricOptions& o = inputs.options();
          const ColorConsistency& found = *inputs.color_consistency.estimate;
          refuse_singletons(o, found);
          if (record.number("n_voxels") == 0.0) {
            warnings.push_back({"color_consistency_no_voxels",
                                fmt::format("no {} m voxel of the evaluated map holds {} points: no color consistency",
                                            o.ccs_voxel_m, o.ccs_min_points)});
          }
          warn_of_singletons(o, found, warnings);
          add_rest(record, found, inputs.estimate);
          if (o.ccs_phases) add_phases(record, inputs.consistency_phases);
          if (inputs.pair == nullptr) return;
          add_rest(record.part_to_change("reference"), *inputs.color_consistency.reference, inputs.pair->reference);
        },
    .levels =
        [](Record& record, LevelInputs& levels, std::vector<Warning>&) {
          add_floor(record, own_level(*levels.inputs.color_consistency.reference));
          add_chance(record, chance_level(levels.estimate_colors()));
        }};

}  // namespace catalog
}  // namespace cmap
