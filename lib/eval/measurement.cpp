#include "measurement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cmap {

std::vector<const Metric*> selected_metrics(const MetricSelection& selection, bool with_color) {
  std::vector<const Metric*> metrics;
  for (const Metric* metric : metric_list()) {
    const bool possible = with_color || !metric->info.needs_color;
    if (possible && selection.contains(metric->info.id)) metrics.push_back(metric);
  }
  return metrics;
}

void find_fields(std::span<const Metric* const> metrics, MetricInputs& inputs, StageClock& clock) {
  for (auto first = metrics.begin(); first != metrics.end();) {
    const std::string_view group = (*first)->info.group;
    const auto next = std::find_if(first, metrics.end(), [&](const Metric* m) { return m->info.group != group; });
    const bool any = std::any_of(first, next, [](const Metric* m) { return m->prepare != nullptr; });
    const auto prepare = [&] {
      for (const Metric* metric : std::span(first, next)) {
        if (metric->prepare != nullptr) metric->prepare(inputs);
      }
    };
    if (any) clock.run(std::string(group).c_str(), 0.7, prepare);
    first = next;
  }
}

MetricRecords with_missing(const MetricSelection& selection, std::vector<MetricRecord> computed) {
  std::vector<MetricRecord> records;
  auto next = computed.begin();
  for (const Metric* metric : selected_metrics(selection, true)) {
    const bool is_there = next != computed.end() && next->info == &metric->info;
    records.push_back(is_there ? std::move(*next++) : MetricRecord{&metric->info, Record{.value = NAN}});
  }
  return MetricRecords(std::move(records));
}

const Record* MetricRecords::find(std::string_view id) const {
  const auto found = std::ranges::find_if(records_, [&](const MetricRecord& m) { return m.info->id == id; });
  return found == records_.end() ? nullptr : &found->record;
}

const Record& MetricRecords::at(std::string_view id) const {
  if (const Record* record = find(id)) return *record;
  std::vector<std::string_view> ids;
  for (const MetricRecord& record : records_) ids.push_back(record.info->id);
  throw std::out_of_range(fmt::format("metric \"{}\" was not computed; there are {}", id, fmt::join(ids, ", ")));
}

}  // namespace cmap
