#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

namespace cmap {

/// The number of a key. Throws UsageError that names it: no number, or not between these.
double camera_number(const std::string& key, const nlohmann::ordered_json& value, double above, double below);

/// A list of so many coordinates. Throws UsageError that names the key.
Eigen::VectorXd camera_numbers(const std::string& key, const nlohmann::ordered_json& value, Eigen::Index n);

/// The value of a key. Throws UsageError where there is none.
const nlohmann::ordered_json& camera_member(const nlohmann::ordered_json& object, const char* key);

}  // namespace cmap
