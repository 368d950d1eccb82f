#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cmap/io/json_text.hpp"

namespace cmap {

/// read_json() and its kin for data in place of configuration: what is wrong is an InputError.
void read_input_json(const std::string& text, const std::string& source, const JsonReader& read);
void read_parsed_input_json(const nlohmann::ordered_json& parsed, const std::string& source, const JsonReader& read);
void read_input_json_file(const std::filesystem::path& path, const std::string& kind, const JsonReader& read);

/// Throws UsageError naming the key unless `json` is an object with all of `required` and nothing else but `optional`;
/// `where` is its place in the file ("camera"; empty: the file itself).
void check_keys(const nlohmann::ordered_json& json, std::string_view where,
                std::initializer_list<std::string_view> required,
                std::initializer_list<std::string_view> optional = {});

/// A member that must be a finite number, or a whole number that fits an int. Throws UsageError naming it.
double finite_number(const nlohmann::ordered_json& json, std::string_view name);
int whole_number(const nlohmann::ordered_json& json, std::string_view name);

}  // namespace cmap
