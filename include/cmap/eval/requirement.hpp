#pragma once

#include <optional>
#include <string>

#include "cmap/eval/map_evaluation.hpp"

namespace cmap {

/// A condition on a result: `LCR>=0.2`, `chamfer<=0.5`, `accuracy@0.1<=0.06`, `LCR.coverage>=50%`.
struct Requirement {
  std::string text;  ///< as given
  const MetricInfo* metric;
  std::optional<double> threshold_m;  ///< after the @
  std::string field;                  ///< after the dot; empty means value
  std::string comparison;             ///< >=, <=, >, <, ==
  double bound;
};

/// Parses an expression and checks that the options compute it. Throws UsageError naming the expression and the reason:
/// syntax, unknown metric, a metric that is not computed, a missing or unlisted threshold.
Requirement parse_requirement(const std::string& text, const EvaluationOptions& options);

/// The same for one map without a reference.
Requirement parse_map_requirement(const std::string& text, const EvaluationOptions& options);

/// What a requirement found; a null value fails it, but for the decibels of exact colors, which are infinite.
struct RequirementOutcome {
  bool holds;
  std::optional<double> value;
};

/// Throws UsageError where the record has no such field.
RequirementOutcome check(const Requirement& requirement, const Evaluation& evaluation);
RequirementOutcome check(const Requirement& requirement, const MapEvaluation& evaluation);

}  // namespace cmap
