#pragma once

#include "eval/metric_records.hpp"

namespace cmap {

/// Confidence intervals of the selected metrics, and the sums over blocks that they were drawn from: the report's
/// `intervals`. Null unless the options ask for a bootstrap; few blocks give a warning.
nlohmann::ordered_json interval_records(const Findings& findings, const LocalColorRecall* recall,
                                        std::vector<Warning>& warnings);

/// The selected metrics over those points alone that the other map could have seen: the report's `unobserved`. Null
/// unless the options ask for it.
nlohmann::ordered_json unobserved_records(const Findings& findings, const LocalColorRecall* recall);

}  // namespace cmap
