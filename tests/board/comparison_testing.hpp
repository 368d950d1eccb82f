#pragma once

// A report to compare, and reports as they are read.

#include "cmap/board/comparison.hpp"
#include "io/io_testing.hpp"
#include "report/report_testing.hpp"

namespace cmap::test {

inline nlohmann::ordered_json some_report() {
  static const nlohmann::ordered_json report = without_levels(report_of(painted_sheet(400, 1), painted_sheet(300, 2)));
  return report;
}

inline SavedReport saved(const std::string& name, const nlohmann::ordered_json& report) {
  return {name + ".json", name, report};
}

}  // namespace cmap::test
