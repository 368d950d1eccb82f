#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cmap/eval/options.hpp"

namespace cmap {

/// All options after defaults, by name: a report's `parameters`, which are a configuration as well.
nlohmann::ordered_json to_json(const EvaluationOptions& options);

}  // namespace cmap
