#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace cmap {

/// The text with the last part alone of every absolute path in it: pages and tables are shared, and the folders of
/// whoever made them are nobody's business. Relative paths stay.
std::string with_file_names(std::string_view text);

/// A report as its page holds it: so in all of its texts. The folders of its inputs are known, and so may hold blanks.
nlohmann::ordered_json shared_report(const nlohmann::ordered_json& report);

}  // namespace cmap
