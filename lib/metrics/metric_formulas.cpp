#include <algorithm>
#include <cmath>

#include "cmap/geometry/order_statistics.hpp"
#include "cmap/metrics/metric_sums.hpp"
#include "metric_columns.hpp"

namespace cmap {
namespace {

/// The order statistics that the metrics ask for, one look at either side's distances for all of them.
std::vector<std::vector<double>> answers(const std::vector<std::vector<DistanceQuantile>>& asked,
                                         const MetricInputs& inputs) {
  std::vector<std::vector<double>> found(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) found[i].resize(asked[i].size());
  if (inputs.pair == nullptr) return found;
  for (const Side side : inputs.sides()) {
    std::vector<PrefixQuantile> wanted;
    std::vector<double*> places;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      for (std::size_t k = 0; k < asked[i].size(); ++k) {
        if (asked[i][k].side != side) continue;
        wanted.push_back({asked[i][k].n_first, asked[i][k].share});
        places.push_back(&found[i][k]);
      }
    }
    if (wanted.empty()) continue;
    const std::vector<double> ranked =
        prefix_quantiles(inputs.pairs(side).nearest.sq_dist, wanted, [](double sq) { return std::sqrt(sq); });
    for (std::size_t k = 0; k < ranked.size(); ++k) *places[k] = ranked[k];
  }
  return found;
}

}  // namespace

std::vector<SummedValue> values_of(std::string_view id, const Record& record) {
  std::vector<SummedValue> values;
  if (record.value) values.push_back({id, std::nullopt, *record.value});
  for (const Record& level : record.list("per_threshold")) values.push_back({id, level.threshold_m, *level.value});
  return values;
}

MetricFormulas::MetricFormulas(const MetricSums& sums, const MetricSettings& settings)
    : settings_(settings), n_parts_(sums.n_parts) {
  for (const Metric* metric : metric_list()) {
    if (metric->value == nullptr) continue;
    const Metric& source = summed(*metric);
    const auto same = std::ranges::find(formulas_, &source, [](const Formula& f) { return &summed(*f.metric); });
    Formula formula = same == formulas_.end() ? Formula{metric, {}} : Formula{metric, same->columns};
    for (const Side side : {Side::kEstimate, Side::kReference}) {
      if (same == formulas_.end() && has_side(source, side))
        formula.columns.of(side) = find_columns(sums, source, side);
    }
    const Columns& needed = formula.columns.of(source.sides == Sides::kReference ? Side::kReference : Side::kEstimate);
    const bool needs_both = source.sides == Sides::kBoth && metric->info.needs_reference;
    if (needed.size == 0 || (needs_both && formula.columns.reference.size == 0)) continue;
    formulas_.push_back(formula);
  }
}

MetricFormulas::Columns MetricFormulas::find_columns(const MetricSums& sums, const Metric& source, Side side) {
  const std::size_t first = columns_.size();
  for (const std::string& name : source.columns(settings_)) {
    const auto column = sums.columns.find(column_name(source, side, name));
    if (column == sums.columns.end()) {
      columns_.resize(first);
      return {};
    }
    columns_.push_back(column->second);
  }
  return {first, columns_.size() - first};
}

std::vector<double> MetricFormulas::totals(std::span<const double> weights) const {
  std::vector<double> totals;
  for (const std::span<const double> column : columns_) {
    double total = 0.0;
    for (std::size_t part = 0; part < n_parts_; ++part) total += weights[part] * column[part];
    totals.push_back(total);
  }
  return totals;
}

PairSums MetricFormulas::sums_for(const Formula& formula, std::span<const double> totals) {
  const auto side = [&](const Columns& columns) { return totals.subspan(columns.first, columns.size); };
  return {side(formula.columns.estimate), side(formula.columns.reference)};
}

std::vector<SummedValue> MetricFormulas::values(std::span<const double> weights) const {
  const std::vector<double> sums = totals(weights);
  std::vector<SummedValue> values;
  for (const Formula& formula : formulas_) {
    const Record record = formula.metric->value(sums_for(formula, sums), settings_);
    for (const SummedValue& value : values_of(formula.metric->info.id, record)) values.push_back(value);
  }
  return values;
}

WholeSums::WholeSums(const MetricSums& sums, const MetricSettings& settings)
    : formulas_(sums, settings), totals_(formulas_.totals(std::vector<double>(sums.n_parts, 1.0))) {}

PairSums WholeSums::of(const Metric& metric) const {
  const auto& formulas = formulas_.formulas_;
  const auto found = std::ranges::find(formulas, &metric, &MetricFormulas::Formula::metric);
  return found == formulas.end() ? PairSums{} : MetricFormulas::sums_for(*found, totals_);
}

std::vector<MetricRecord> finished_records(std::span<const Metric* const> metrics, const WholeSums& whole,
                                           const MetricInputs& inputs, std::vector<Warning>& warnings) {
  std::vector<MetricRecord> records;
  std::vector<std::vector<DistanceQuantile>> asked;
  for (const Metric* metric : metrics) {
    const PairSums sums = whole.of(*metric);
    records.push_back({&metric->info, metric->value == nullptr ? Record{} : metric->value(sums, inputs.settings)});
    asked.emplace_back();
    if (metric->quantiles != nullptr) asked.back() = metric->quantiles(sums, inputs);
  }
  const std::vector<std::vector<double>> quantiles = answers(asked, inputs);
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (metrics[i]->finish != nullptr) metrics[i]->finish(records[i].record, inputs, quantiles[i], warnings);
  }
  return records;
}

Record measure(const Metric& metric, MetricInputs& inputs, std::vector<Warning>& warnings) {
  const Metric* const one[]{&metric};
  if (metric.prepare != nullptr) metric.prepare(inputs);
  const MetricSums sums = sum_metrics(one, inputs);
  return finished_records(one, WholeSums(sums, inputs.settings), inputs, warnings).front().record;
}

}  // namespace cmap
