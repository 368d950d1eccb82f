#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cmap {

/// Which number of a report: a metric, and one of its thresholds or distance bins where it has them.
struct ScoreKind {
  std::string metric;  ///< id
  std::string part;    ///< "coverage" of local_color_recall; else empty
  std::string at;      ///< "0.2" for a threshold, "0-0.05" for a bin, in meters; else empty
  std::string title;   ///< for people: "accuracy <= 0.2 m"
  std::string symbol, unit, better;
  bool share = false;     ///< read in percent
  bool headline = false;  ///< the one value of its metric, or that of the first threshold

  std::string id() const;  ///< "accuracy@0.2", "local_color_recall.coverage"
};

struct Score {
  ScoreKind kind;
  std::optional<double> value;
};

/// All scores of a report that read_report took, in its order of metrics; recall is followed by its coverage.
std::vector<Score> scores_of(const nlohmann::ordered_json& report);

/// The kinds that any of the reports has, in the catalog's order.
std::vector<ScoreKind> kinds_of(const std::vector<std::vector<Score>>& reports);

std::optional<double> value_of(const std::vector<Score>& scores, const ScoreKind& kind);

}  // namespace cmap
