#include "cmap/metrics/metric_sums.hpp"

#include <algorithm>

#include "cmap/core/parallel.hpp"
#include "metric_columns.hpp"
#include "point_runs.hpp"

namespace cmap {
namespace {

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

/// Columns of these names in the sums, by part.
class ColumnTable {
 public:
  ColumnTable(MetricSums& sums, std::span<const std::string> names) {
    for (const std::string& name : names) {
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
  const bool with_colors =
      std::ranges::any_of(columns.ranges, [](const ColumnRange& range) { return range.metric->info.needs_color; });
  std::vector<TaskSums> sums(tasks.size());
  parallel_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) {
    RunReader reader(inputs, side, with_colors);
    sums[task] = sum_task(tasks[task], reader, columns);
  });
  ColumnTable table(result, columns.names);
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
    ColumnTable table(result, std::span(columns.names).subspan(range.first, range.size));
    const std::vector<ColumnSums> by_part = voxel_sums(*range.metric, inputs, side, parts, range.size);
    for (std::size_t part = 0; part < by_part.size(); ++part) {
      table.set(static_cast<std::uint32_t>(part), numbers(by_part[part]));
    }
  }
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

}  // namespace cmap
