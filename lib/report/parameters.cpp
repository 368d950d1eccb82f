#include "cmap/report/parameters.hpp"

#include <nlohmann/json.hpp>

#include "cmap/io/options_json.hpp"

namespace cmap {

nlohmann::ordered_json to_json(const EvaluationOptions& options) {
  EvaluationOptions copy = options;
  return options_json(option_fields(copy));
}

}  // namespace cmap
