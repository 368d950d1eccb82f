#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// Collects the records of those metrics that are selected; nothing is computed for the others.
class RecordList {
 public:
  explicit RecordList(const MetricSelection& selection) : selection_(selection) {}

  template <class Fields>
  void add(std::string_view id, Fields&& fields) {
    if (selection_.contains(id)) records_.push_back({find_metric(id), fields()});
  }

  std::vector<MetricRecord> take() { return std::move(records_); }

 private:
  const MetricSelection& selection_;
  std::vector<MetricRecord> records_;
};

}  // namespace cmap
