#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cmap {

using JsonReader = std::function<void(const nlohmann::ordered_json&)>;

/// Hands `read` the JSON of a configuration (comments allowed). Throws UsageError that names `source`: syntax with line
/// and column, a key given twice in one object, and whatever UsageError or JSON type error `read` throws.
void read_json(const std::string& text, const std::string& source, const JsonReader& read);

/// The same of JSON that is parsed already, as where it is read in parts.
void read_parsed_json(const nlohmann::ordered_json& parsed, const std::string& source, const JsonReader& read);

/// The same for a file; `kind` is what it should be, for the message: "a camera".
void read_json_file(const std::filesystem::path& path, const std::string& kind, const JsonReader& read);

}  // namespace cmap
