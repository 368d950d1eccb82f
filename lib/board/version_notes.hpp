#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cmap/board/comparison.hpp"

namespace cmap {

/// "none for a; given for b" where the reports' texts at that place differ.
std::optional<std::string> difference(const std::vector<SavedReport>& reports,
                                      const nlohmann::ordered_json::json_pointer& place);

}  // namespace cmap
