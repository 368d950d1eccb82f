#include "cmap/metrics/metric_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cmap/core/parallel.hpp"
#include "cmap/metrics/order_statistics.hpp"
#include "metrics/point_runs.hpp"

namespace cmap {
namespace {

/// The metric whose columns these sums are.
const Metric& summed(const Metric& metric) { return metric.sums_of == nullptr ? metric : *metric.sums_of; }

bool has_side(const Metric& metric, Side side) {
  return metric.sides == Sides::kBoth || (metric.sides == Sides::kEstimate) == (side == Side::kEstimate);
}

std::string column_name(const Metric& metric, Side side, const std::string& column) {
  return fmt::format("{}.{}.{}", metric.info.id, side == Side::kEstimate ? "estimate" : "reference", column);
}

/// A metric's columns among those of all metrics that are summed over one side.
struct ColumnRange {
  const Metric* metric;
  std::size_t first, size;
};

struct SideColumns {
  std::vector<ColumnRange> ranges;
  std::vector<std::string> names;
};

/// Of the metrics for which `is_wanted`, each once.
template <class IsWanted>
SideColumns columns_of(std::span<const Metric* const> metrics, const MetricSettings& settings, Side side,
                       IsWanted is_wanted) {
  SideColumns columns;
  for (const Metric* metric : metrics) {
    const Metric& source = summed(*metric);
    if (source.columns == nullptr || !has_side(source, side) || !is_wanted(source)) continue;
    if (std::ranges::count(columns.ranges, &source, &ColumnRange::metric) > 0) continue;
    const std::vector<std::string> names = source.columns(settings);
    columns.ranges.push_back({&source, columns.names.size(), names.size()});
    for (const std::string& name : names) columns.names.push_back(column_name(source, side, name));
  }
  return columns;
}

using ColumnSums = std::vector<ExactSum>;

void add_run(const PointRun& run, const SideColumns& columns, ColumnSums& sums) {
  for (const ColumnRange& range : columns.ranges) {
    range.metric->add(run, std::span(sums).subspan(range.first, range.size));
  }
}

/// One part's sums: as numbers where a task has seen all of the part, exact where its neighbors may hold more.
struct TaskSums {
  std::uint32_t first_part = 0, last_part = 0;
  ColumnSums first, last;  ///< one and the same where there is one part: `last` is empty then
  std::vector<std::pair<std::uint32_t, std::vector<double>>> between;
};

std::vector<double> numbers(const ColumnSums& sums) {
  std::vector<double> values;
  for (const ExactSum& sum : sums) values.push_back(sum.value());
  return values;
}

TaskSums sum_task(std::span<const SlotRun> runs, RunReader& reader, const SideColumns& columns) {
  TaskSums task{runs.front().part, runs.back().part, {}, {}, {}};
  ColumnSums sums(columns.names.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    add_run(reader.read(runs[i]), columns, sums);
    if (i + 1 < runs.size() && runs[i + 1].part == runs[i].part) continue;
    if (runs[i].part == task.first_part) {
      task.first = std::move(sums);
    } else if (i + 1 == runs.size()) {
      task.last = std::move(sums);
    } else {
      task.between.emplace_back(runs[i].part, numbers(sums));
    }
    sums.assign(columns.names.size(), {});
  }
  return task;
}

/// The columns of a side in the sums, by part.
class ColumnTable {
 public:
  ColumnTable(MetricSums& sums, const SideColumns& columns) {
    for (const std::string& name : columns.names) {
      columns_.push_back(&sums.columns.try_emplace(name, std::vector<double>(sums.n_parts)).first->second);
    }
  }
  void set(std::uint32_t part, std::span<const double> values) {
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      if (part >= columns_[column]->size()) columns_[column]->resize(part + 1);
      (*columns_[column])[part] = values[column];
    }
  }

 private:
  std::vector<std::vector<double>*> columns_;
};

void add_all(ColumnSums& sums, const ColumnSums& more) {
  for (std::size_t column = 0; column < sums.size(); ++column) sums[column] += more[column];
}

/// Parts that several tasks have seen are put together.
void merge(std::vector<TaskSums> tasks, ColumnTable& table) {
  std::uint32_t part = 0;
  ColumnSums open;
  const auto close = [&] {
    if (!open.empty()) table.set(part, numbers(open));
    open.clear();
  };
  const auto take = [&](std::uint32_t of_part, ColumnSums& sums) {
    if (!open.empty() && of_part == part) return add_all(open, sums);
    close();
    part = of_part;
    open = std::move(sums);
  };
  for (TaskSums& task : tasks) {
    take(task.first_part, task.first);
    for (const auto& [between, values] : task.between) table.set(between, values);
    if (!task.last.empty()) take(task.last_part, task.last);
  }
  close();
}

void sum_points(std::span<const Metric* const> metrics, const MetricInputs& inputs, Side side, const SpaceParts& parts,
                MetricSums& result) {
  const SideColumns columns =
      columns_of(metrics, inputs.settings, side, [](const Metric& metric) { return metric.add != nullptr; });
  if (columns.ranges.empty()) return;
  const std::vector<SlotRun> runs = slot_runs(inputs.map(side).size(), parts.of_slots.of(side));
  const std::vector<std::span<const SlotRun>> tasks = run_tasks(runs);
  std::vector<TaskSums> sums(tasks.size());
  parallel_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) {
    RunReader reader(inputs, side);
    sums[task] = sum_task(tasks[task], reader, columns);
  });
  ColumnTable table(result, columns);
  merge(std::move(sums), table);
}

/// The sums of one metric's voxels, by part.
std::vector<ColumnSums> voxel_sums(const Metric& metric, const MetricInputs& inputs, Side side, const SpaceParts& parts,
                                   std::size_t n_columns) {
  std::vector<ColumnSums> by_part(1, ColumnSums(n_columns));
  if (!parts.of_voxel && metric.add_voxels != nullptr) {
    metric.add_voxels(inputs, side, by_part.front());
    return by_part;
  }
  metric.each_voxel(inputs, side, [&](const VoxelTerms& voxel) {
    std::uint32_t part = 0;
    if (parts.of_voxel) {
      const auto center = [&](std::size_t axis) {
        return (static_cast<double>(voxel.index[axis]) + 0.5) * voxel.voxel_m;
      };
      part = parts.of_voxel({center(0), center(1), center(2)});
    }
    if (part >= by_part.size()) by_part.resize(part + 1, ColumnSums(n_columns));
    for (std::size_t column = 0; column < n_columns; ++column) by_part[part][column].add(voxel.terms[column]);
  });
  return by_part;
}

void sum_voxels(std::span<const Metric* const> metrics, const MetricInputs& inputs, Side side, const SpaceParts& parts,
                MetricSums& result) {
  const SideColumns columns =
      columns_of(metrics, inputs.settings, side, [](const Metric& metric) { return metric.each_voxel != nullptr; });
  for (const ColumnRange& range : columns.ranges) {
    SideColumns own{{range}, {}};
    const auto first = columns.names.begin() + static_cast<std::ptrdiff_t>(range.first);
    own.names.assign(first, first + static_cast<std::ptrdiff_t>(range.size));
    ColumnTable table(result, own);
    const std::vector<ColumnSums> by_part = voxel_sums(*range.metric, inputs, side, parts, range.size);
    for (std::size_t part = 0; part < by_part.size(); ++part) {
      table.set(static_cast<std::uint32_t>(part), numbers(by_part[part]));
    }
  }
}

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

MetricSums sum_metrics(std::span<const Metric* const> metrics, const MetricInputs& inputs, SpaceParts parts) {
  MetricSums sums{parts.n, {}};
  for (const Side side : inputs.sides()) sum_points(metrics, inputs, side, parts, sums);
  for (const Side side : inputs.sides()) sum_voxels(metrics, inputs, side, parts, sums);
  for (const auto& [name, column] : sums.columns) sums.n_parts = std::max(sums.n_parts, column.size());
  for (auto& [name, column] : sums.columns) column.resize(sums.n_parts);
  return sums;
}

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
