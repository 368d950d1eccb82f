#pragma once

// Metric records against expected ones, every number with the path where it differs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include "cmap/core/error.hpp"
#include "cmap/eval/evaluation.hpp"
#include "cmap/report/record_json.hpp"

namespace cmap::test {

using Json = nlohmann::ordered_json;

inline std::filesystem::path source_folder() {
  const char* folder = std::getenv("CMAP_SOURCE_DIR");
  return folder == nullptr ? std::filesystem::current_path() : std::filesystem::path(folder);
}

inline Json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return Json::parse(file);
}

/// How far a number may be from the expected one: relative, or absolute for what should be 0.
struct Tolerance {
  double relative;
  double absolute;
};

/// Largest relative difference of numbers that are not 0, by metric.
class WorstDifferences {
 public:
  void add(const std::string& metric, double expected, double found) {
    double& worst = worst_[metric];
    if (expected != 0.0) worst = std::max(worst, std::abs(found - expected) / std::abs(expected));
  }
  void print(const std::string& title) const {
    std::cout << "worst relative differences, " << title << ":\n";
    for (const auto& [metric, worst] : worst_) std::cout << "  " << metric << ' ' << worst << '\n';
  }

 private:
  std::map<std::string, double> worst_;
};

/// Everything that `expected` names must be in `found`: counts and text exactly, null as null, other numbers within the
/// tolerance. Where `found` says more, that is its own affair.
class RecordComparison {
 public:
  RecordComparison(Tolerance tolerance, WorstDifferences& worst) : tolerance_(tolerance), worst_(worst) {}

  void compare(const std::string& metric, const Json& expected, const Json& found) {
    at(metric, expected, found, metric);
  }

 private:
  void at(const std::string& metric, const Json& expected, const Json& found, const std::string& path) {
    if (expected.is_object() && found.is_object()) {
      for (const auto& [key, value] : expected.items()) {
        if (found.contains(key)) {
          at(metric, value, found.at(key), path + "/" + key);
        } else {
          ADD_FAILURE() << path << "/" << key << " is missing";
        }
      }
    } else if (expected.is_array() && found.is_array() && expected.size() == found.size()) {
      for (std::size_t i = 0; i < expected.size(); ++i)
        at(metric, expected[i], found[i], path + "/" + std::to_string(i));
    } else if (expected.is_number_float() && found.is_number()) {
      number(metric, expected.get<double>(), found.get<double>(), path);
    } else {
      EXPECT_EQ(expected, found) << path;
    }
  }

  void number(const std::string& metric, double expected, double found, const std::string& path) {
    worst_.add(metric, expected, found);
    const double allowed = std::max(tolerance_.absolute, tolerance_.relative * std::abs(expected));
    // Written so that NaN fails.
    EXPECT_TRUE(std::abs(found - expected) <= allowed)
        << path << ": expected " << expected << ", found " << found << ", relative difference "
        << std::abs(found - expected) / std::abs(expected);
  }

  Tolerance tolerance_;
  WorstDifferences& worst_;
};

/// A metric's record as reports hold it. Throws std::out_of_range for one that was not computed.
inline Json fields_of(const Evaluation& evaluation, std::string_view id) {
  return record_json(evaluation.metrics.at(id));
}

/// What another tool would print.
inline Json peer_fields(const Evaluation& evaluation, std::string_view tool) {
  return record_json(*std::ranges::find(evaluation.peers, tool, &PeerRecord::tool)->record);
}

/// The records of two evaluations that should be one.
inline void expect_same_records(const Evaluation& expected, const Evaluation& found, Tolerance tolerance,
                                WorstDifferences& worst) {
  ASSERT_EQ(expected.metrics.size(), found.metrics.size());
  ASSERT_FALSE(expected.metrics.empty());
  for (const MetricRecord& metric : expected.metrics) {
    const std::string id(metric.info->id);
    RecordComparison(tolerance, worst).compare(id, record_json(metric.record), fields_of(found, id));
  }
}

}  // namespace cmap::test
