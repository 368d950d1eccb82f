#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cmap {

/// Which number of a report: a metric, and one of its thresholds or distance bins where it has them.
struct ScoreKind {
  std::string metric;  ///< id
  std::string part;    ///< "skill" of what has one, "coverage" of local_color_recall; else empty
  std::string at;      ///< "0.2" for a threshold, "0-0.05" for a bin, in meters; else empty
  std::string title;   ///< for people: "accuracy <= 0.2 m"
  std::string symbol, unit, better;
  bool share = false;     ///< read in percent
  bool headline = false;  ///< the one value of its metric, or that of the first threshold

  std::string id() const;  ///< "accuracy@0.2", "local_color_recall.coverage"
};

/// A score on grids that begin at other places, by place; nothing where no voxel qualifies.
struct Phases {
  std::vector<std::optional<double>> values;
  double std = 0.0, min = 0.0, max = 0.0;
};

struct Score {
  ScoreKind kind;
  std::optional<double> value;
  std::optional<double> floor = {}, chance = {};  ///< what a perfect map, and one of shuffled colors, could expect
  std::optional<Phases> phases = {};              ///< where two or more have a value
  std::string reason = {};                        ///< why there is no skill, as the report says
};

/// All scores of a report that read_report took, in its order of metrics; a score is followed by its skill, recall by
/// its coverage.
std::vector<Score> scores_of(const nlohmann::ordered_json& report);

/// The kinds that any of the reports has, in the catalog's order.
std::vector<ScoreKind> kinds_of(const std::vector<std::vector<Score>>& reports);

/// Null where the report has no such score.
const Score* score_of(const std::vector<Score>& scores, const ScoreKind& kind);
std::optional<double> value_of(const std::vector<Score>& scores, const ScoreKind& kind);

}  // namespace cmap
