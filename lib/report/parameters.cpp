#include "cmap/report/parameters.hpp"

#include <nlohmann/json.hpp>

#include "cmap/io/options_json.hpp"

namespace cmap {

nlohmann::ordered_json to_json(const EvaluationOptions& options) { return options_json_of(options); }

}  // namespace cmap
