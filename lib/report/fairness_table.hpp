#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cmap {

/// What a report says beside the plain numbers, as lines of its table; empty where it says nothing.
std::string alignment_lines(const nlohmann::ordered_json& report);
std::string sensitivity_lines(const nlohmann::ordered_json& report);
std::string interval_lines(const nlohmann::ordered_json& report);
std::string unobserved_lines(const nlohmann::ordered_json& report);

}  // namespace cmap
