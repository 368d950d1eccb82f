#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cmap/eval/metric_catalog.hpp"

namespace cmap {

/// Four significant digits, as readers of tables expect; a dash for null, a sign for infinity.
std::string digits(const nlohmann::ordered_json& value);

/// A share in percent, without the sign; one that is not zero does not look like it.
std::string hundredths(const nlohmann::ordered_json& value);

/// Whether a metric that has no value in a report is infinite: JSON knows no infinity, so that a warning says it.
bool is_infinite(const nlohmann::ordered_json& report, std::string_view id);

/// A value as its metric is shown.
inline std::string shown(const MetricInfo& info, const nlohmann::ordered_json& value) {
  return info.share ? hundredths(value) : digits(value);
}

/// The unit beside it; none for ratios.
std::string shown_unit(const MetricInfo& info);

/// 12,345
std::string with_thousands(const nlohmann::ordered_json& count);

/// The text with whatever is not UTF-8 replaced: names of files may hold any bytes.
std::string valid_utf8(std::string_view text);

/// Characters of a UTF-8 text, not bytes: arrows and deltas are several bytes long.
std::size_t character_count(std::string_view text);

/// Pads by characters, not bytes: arrows and deltas are several bytes long.
std::string padded(std::string_view text, std::size_t width);

}  // namespace cmap
