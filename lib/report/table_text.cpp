#include "cmap/report/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cmap {

using Json = nlohmann::ordered_json;

std::string digits(const Json& value) {
  if (!value.is_number()) return "-";
  if (std::isinf(value.get<double>())) return value.get<double>() > 0.0 ? "∞" : "-∞";
  // Rounded first: 999.96 has four digits before the point.
  const double v = std::stod(fmt::format("{:.3e}", value.get<double>()));
  if (v == 0.0) return "0";
  const double magnitude = std::abs(v);
  if (magnitude < 1e-4 || magnitude >= 1e6) return fmt::format("{:.3e}", v);
  const int before_point = static_cast<int>(std::floor(std::log10(magnitude))) + 1;
  return fmt::format("{:.{}f}", value.get<double>(), std::max(0, 4 - before_point));
}

std::string hundredths(const Json& value) {
  if (!value.is_number()) return "-";
  const double percent = 100.0 * value.get<double>();
  return percent > 0.0 && percent < 0.005 ? "< 0.01" : fmt::format("{:.2f}", percent);
}

bool is_infinite(const Json& report, std::string_view id) {
  const std::string says_so = fmt::format("{}_infinite", id);
  return std::ranges::any_of(report.at("warnings"), [&](const Json& warning) { return warning.at("id") == says_so; });
}

std::string shown_unit(const MetricInfo& info) {
  if (info.share) return "%";
  return info.unit == "1" ? "" : std::string(info.unit);
}

std::string with_thousands(const Json& count) {
  std::string text = std::to_string(count.get<std::uint64_t>());
  for (std::size_t place = text.size(); place > 3; place -= 3)
    text.insert(text.begin() + static_cast<std::ptrdiff_t>(place - 3), ',');
  return text;
}

std::string valid_utf8(std::string_view text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

std::size_t character_count(std::string_view text) {
  std::size_t characters = 0;
  for (char c : text) characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  return characters;
}

std::string padded(std::string_view text, std::size_t width) {
  const std::size_t characters = character_count(text);
  return std::string(text) + std::string(width > characters ? width - characters : 0, ' ');
}

}  // namespace cmap
