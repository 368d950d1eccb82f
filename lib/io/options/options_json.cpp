#include "cmap/io/options_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Gives a field the value of a JSON text.
class Setter {
 public:
  Setter(const char* name, const Json& json, const std::string& where)
      : json_(json), place_(where.empty() ? name : fmt::format("{}: {}", where, name)) {}

  void operator()(const NumberValue& v) const { *v.value = number(json_, v.range); }
  void operator()(const OptionalNumberValue& v) const {
    *v.value = json_.is_null() ? std::nullopt : std::optional(number(json_, v.range));
  }
  void operator()(const WholeNumberValue& v) const { *v.value = whole_number(json_, v.range); }
  void operator()(const CountValue& v) const { *v.value = count(json_, v.range); }
  void operator()(const FlagValue& v) const {
    if (!json_.is_boolean()) refuse(json_, "is neither true nor false");
    *v.value = json_.get<bool>();
  }
  void operator()(const TextValue& v) const {
    if (!json_.is_string()) refuse(json_, "is not a text");
    *v.value = json_.get<std::string>();
  }
  void operator()(const VectorValue& v) const {
    if (list("numbers").size() != v.size) refuse(json_, fmt::format("is not a list of {} numbers", v.size));
    for (std::size_t i = 0; i < v.size; ++i) v.first[i] = number(json_[i], kAnyNumber);
  }
  void operator()(const NumbersValue& v) const {
    std::vector<double> numbers;
    for (const Json& item : list("numbers")) numbers.push_back(number(item, v.range));
    *v.value = std::move(numbers);
  }
  void operator()(const WholeNumbersValue& v) const {
    std::vector<int> numbers;
    for (const Json& item : list("numbers")) numbers.push_back(whole_number(item, v.range));
    *v.value = std::move(numbers);
  }
  void operator()(const BytesValue& v) const {
    std::vector<std::uint8_t> bytes;
    for (const Json& item : list(v.items)) bytes.push_back(static_cast<std::uint8_t>(count(item, {0, 255})));
    *v.value = std::move(bytes);
  }
  void operator()(const ChoiceValue& v) const {
    // A choice of numbers may be written as one.
    const std::string word = json_.is_number_integer() ? json_.dump()
                             : json_.is_string()       ? json_.get<std::string>()
                                                       : "";
    const auto named = std::ranges::find(v.names, word);
    if (named == v.names.end()) refuse(json_, is_none_of(word, v.names));
    v.set(static_cast<std::size_t>(named - v.names.begin()));
  }
  void operator()(const NumberListValue& v) const {
    std::optional<std::vector<double>> numbers;
    if (!(v.can_be_unset && json_.is_null())) {
      if (list("numbers").empty()) refuse(json_, "is not a list of numbers");
      numbers.emplace();
      for (const Json& item : json_) numbers->push_back(number(item, kAnyNumber));
    }
    const std::string wrong = v.set(numbers);
    if (!wrong.empty()) refuse(json_, wrong);
  }
  void operator()(const NameListValue& v) const {
    for (const Json& item : list("words")) {
      if (!item.is_string()) refuse(json_, "is not a list of words");
    }
    v.set(json_.get<std::vector<std::string>>());
  }

 private:
  [[noreturn]] void refuse(const Json& json, const std::string& reason) const {
    // The command line holds whole numbers as floating-point ones: 300, not 300.0.
    const std::string shown = json.is_number_float() ? fmt::format("{}", json.get<double>()) : json.dump();
    throw UsageError(fmt::format("{}: {} {}", place_, shown, reason));
  }
  double number(const Json& json, const NumberRange& range) const {
    if (!json.is_number()) refuse(json, "is not a number");
    if (!range.holds(json.get<double>())) refuse(json, range.text());
    return json.get<double>();
  }
  int whole_number(const Json& json, const NumberRange& range) const {
    const double value = number(json, range);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
      refuse(json, "is not a whole number");
    }
    return static_cast<int>(value);
  }
  std::uint64_t count(const Json& json, const CountRange& range) const {
    const double value = json.is_number() ? json.get<double>() : -1.0;
    if (value != std::floor(value) || value < static_cast<double>(range.least) ||
        value > static_cast<double>(range.most)) {
      refuse(json, fmt::format("is not a whole number from {} to {}", range.least, range.most));
    }
    return static_cast<std::uint64_t>(value);
  }
  const Json& list(const char* of_what) const {
    if (!json_.is_array()) refuse(json_, fmt::format("is not a list of {}", of_what));
    return json_;
  }

  const Json& json_;
  std::string place_;
};

/// A field's value as JSON.
struct Writer {
  Json operator()(const OptionalNumberValue& v) const { return *v.value ? Json(**v.value) : Json(nullptr); }
  Json operator()(const VectorValue& v) const { return std::vector<double>(v.first, v.first + v.size); }
  Json operator()(const ChoiceValue& v) const { return v.names.at(v.place()); }
  Json operator()(const NumberListValue& v) const {
    const auto numbers = v.get();
    return numbers ? Json(*numbers) : Json(nullptr);
  }
  Json operator()(const NameListValue& v) const { return v.get(); }
  Json operator()(const auto& v) const { return *v.value; }
};

}  // namespace

void set_from_json(const OptionField& field, const Json& value, const std::string& where) {
  std::visit(Setter(field.name, value, where), field.value);
}

void set_from_json(const OptionFields& fields, const Json& object, const std::string& where) {
  const std::string place = where.empty() ? "" : where + ": ";
  if (!object.is_object()) throw UsageError(place + "expected a JSON object of options");
  for (const auto& [key, value] : object.items()) {
    const auto field = std::ranges::find_if(fields, [&](const OptionField& known) { return key == known.name; });
    if (field == fields.end()) {
      throw UsageError(fmt::format("{}unknown key \"{}\"{}", place, key, did_you_mean(key, names_of(fields))));
    }
    set_from_json(*field, value, where);
  }
}

Json value_json(const OptionField& field) { return std::visit(Writer(), field.value); }

Json options_json(const OptionFields& fields) {
  Json json = Json::object();
  for (const OptionField& field : fields) json[field.name] = value_json(field);
  return json;
}

OptionAssignment read_assignment(const std::string& assignment, const char* form) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("\"{}\" is not {}", assignment, form));
  }
  const std::string text = assignment.substr(equals + 1);
  Json value = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  return {assignment.substr(0, equals), value.is_discarded() ? Json(text) : std::move(value)};
}

}  // namespace cmap
