#pragma once

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// What the tools of options.as would print, by their own names; fields that they need are made where they are missing.
/// Warnings are appended.
std::vector<PeerRecord> peer_records(MetricInputs& inputs, const EvaluationOptions& options,
                                     std::vector<Warning>& warnings);

}  // namespace cmap
