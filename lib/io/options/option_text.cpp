#include "cmap/io/option_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/io/options_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// The parts between commas, without the blanks around them.
std::vector<std::string> split(const std::string& text) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string> parts;
  if (text.find_first_not_of(kBlanks) == text.npos) return parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    const std::size_t first = part.find_first_not_of(kBlanks);
    parts.push_back(first == part.npos ? "" : part.substr(first, part.find_last_not_of(kBlanks) + 1 - first));
    begin = comma + 1;
  }
  return parts;
}

/// The text of a field's value as JSON of the right type.
struct Parser {
  const char* name;
  const std::string& text;

  Json operator()(const FlagValue&) const {
    return text == "true" ? Json(true) : text == "false" ? Json(false) : Json(text);
  }
  Json operator()(const TextValue&) const { return text; }
  Json operator()(const ChoiceValue&) const { return text; }
  Json operator()(const NameListValue&) const { return split(text); }
  Json operator()(const VectorValue&) const { return numbers(); }
  Json operator()(const NumbersValue&) const { return numbers(); }
  Json operator()(const WholeNumbersValue&) const { return numbers(); }
  Json operator()(const BytesValue&) const { return numbers(); }
  Json operator()(const NumberListValue&) const { return numbers(); }
  Json operator()(const auto&) const { return number(text); }

 private:
  Json numbers() const {
    Json list = Json::array();
    for (const std::string& part : split(text)) list.push_back(number(part));
    return list;
  }
  /// From all of the text.
  double number(const std::string& part) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) {
      throw UsageError(fmt::format("{}: \"{}\" is not a number", name, part));
    }
    return value;
  }
};

std::string typed(const Json& value) {
  if (value.is_null() || value.empty()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& item : value) text += fmt::format("{}{}", text.empty() ? "" : ",", typed(item));
  return text;
}

}  // namespace

bool is_flag(const OptionField& field) { return std::holds_alternative<FlagValue>(field.value); }

void set_from_text(const OptionField& field, const std::string& text) {
  set_from_json(field, std::visit(Parser{field.name, text}, field.value));
}

std::string value_text(const OptionField& field) { return typed(value_json(field)); }

std::vector<std::string> arguments_for(const OptionFields& fields, const OptionFields& others) {
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (value_json(fields[i]) == value_json(others.at(i))) continue;
    arguments.push_back(fmt::format("--{}", fields[i].name));
    if (!is_flag(fields[i])) arguments.push_back(value_text(fields[i]));
  }
  return arguments;
}

}  // namespace cmap
