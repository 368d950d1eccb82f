#pragma once

// Scores as text: what all tables of cmap share.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace cmap {

inline constexpr std::string_view kNoValue = "-";

/// Four significant digits, as readers of such tables expect; plain for ordinary sizes. A dash for what is no number.
std::string digits(const nlohmann::ordered_json& value);

/// A share in percent, without the sign; one that is not zero does not look like it.
std::string hundredths(const nlohmann::ordered_json& value);

std::string percent(const nlohmann::ordered_json& value);

std::string with_thousands(const nlohmann::ordered_json& count);

/// Characters of a UTF-8 text: arrows and deltas are several bytes long.
std::size_t character_count(std::string_view text);

/// Pads at the right to a width in characters.
std::string padded(std::string_view text, std::size_t width);

/// Metrics between 0 and 1 that people read in percent.
bool is_share(std::string_view metric_id);

}  // namespace cmap
