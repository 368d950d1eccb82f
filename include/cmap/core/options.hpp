#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cmap/core/enum_names.hpp"

/// A struct of options is described once, by a list of its fields: name, place and rule of the value, and what people
/// are told. Ordinary functions over the list check values, read and write JSON (io/options_json.hpp), and take and
/// give the text of a command line (io/option_text.hpp).
namespace cmap {

/// Values that a number may have.
struct NumberRange {
  double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
  bool above_low = false;  ///< `low` itself is no value

  bool holds(double v) const;
  std::string text() const;  ///< "must be above 0"
};

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.low = 0.0, .above_low = true};
inline constexpr NumberRange kNotNegative{.low = 0.0};
inline constexpr NumberRange kFraction{.low = 0.0, .high = 1.0};

/// Values that a count may have, both ends included.
struct CountRange {
  std::uint64_t least = 0, most = 0;
};

// What a value may be, and where it lies.
struct NumberValue {
  double* value;
  NumberRange range;
};
struct OptionalNumberValue {
  std::optional<double>* value;
  NumberRange range;
};
struct WholeNumberValue {
  int* value;
  NumberRange range;
};
struct CountValue {
  std::uint64_t* value;
  CountRange range;
};
struct FlagValue {
  bool* value;
};
struct TextValue {
  std::string* value;
};
struct VectorValue {
  double* first;
  std::size_t size;
};
struct NumbersValue {
  std::vector<double>* value;
  NumberRange range;
};
struct WholeNumbersValue {
  std::vector<int>* value;
  NumberRange range;
};
/// Whole numbers from 0 to 255, as the classes of LAS.
struct BytesValue {
  std::vector<std::uint8_t>* value;
  const char* items;  ///< "classes"
};
/// One of some names.
struct ChoiceValue {
  std::vector<std::string> names;
  std::function<std::size_t()> place;    ///< of the value among the names; names.size() for one without a name
  std::function<void(std::size_t)> set;  ///< to the value of the name at that place
};
/// Numbers with a rule of their own.
struct NumberListValue {
  std::function<std::optional<std::vector<double>>()> get;
  /// Sets them, or says what is wrong with them: "has a maximum below its minimum".
  std::function<std::string(const std::optional<std::vector<double>>&)> set;
  bool can_be_unset = false;
};
/// Names with a rule of their own.
struct NameListValue {
  std::function<std::vector<std::string>()> get;
  std::function<void(const std::vector<std::string>&)> set;  ///< throws UsageError that names the option
};

using OptionValue =
    std::variant<NumberValue, OptionalNumberValue, WholeNumberValue, CountValue, FlagValue, TextValue, VectorValue,
                 NumbersValue, WholeNumbersValue, BytesValue, ChoiceValue, NumberListValue, NameListValue>;

/// What an option is for the numbers of a result.
enum class OptionRole {
  kDefinition,  ///< numbers computed with another value do not compare
  kBeside,      ///< chooses what is computed beside the numbers; changes none
};

/// One option: a value in a struct, which must outlive it.
struct OptionField {
  const char* name;  ///< in files and reports; on the command line with dashes before it
  OptionValue value;
  std::string placeholder = {};  ///< for help: "METERS"
  const char* help = "";
  OptionRole role = OptionRole::kDefinition;
};

using OptionFields = std::vector<OptionField>;

/// Throws UsageError "where: name: value and rule" for the first value that was set in code to what it may not be.
void check_options(const OptionFields& fields, const std::string& where);

std::vector<std::string> names_of(const OptionFields& fields);

/// The lists one after the other.
OptionFields joined(const std::vector<OptionFields>& lists);

// A field of each type.
inline OptionField field(const char* name, double& v, const NumberRange& range = kAnyNumber, const char* unit = "",
                         const char* help = "") {
  return {name, NumberValue{&v, range}, unit, help};
}
inline OptionField field(const char* name, std::optional<double>& v, const NumberRange& range, const char* unit,
                         const char* help) {
  return {name, OptionalNumberValue{&v, range}, unit, help};
}
inline OptionField field(const char* name, int& v, const NumberRange& range) {
  return {name, WholeNumberValue{&v, range}};
}
inline OptionField field(const char* name, std::uint64_t& v, const CountRange& range, const char* unit,
                         const char* help) {
  return {name, CountValue{&v, range}, unit, help};
}
inline OptionField field(const char* name, bool& v, const char* help = "") { return {name, FlagValue{&v}, {}, help}; }
inline OptionField field(const char* name, std::string& v) { return {name, TextValue{&v}}; }
inline OptionField field(const char* name, Eigen::Vector2d& v) { return {name, VectorValue{v.data(), 2}}; }
inline OptionField field(const char* name, Eigen::Vector3d& v) { return {name, VectorValue{v.data(), 3}}; }
inline OptionField field(const char* name, std::vector<double>& v, const NumberRange& range) {
  return {name, NumbersValue{&v, range}};
}
inline OptionField field(const char* name, std::vector<int>& v, const NumberRange& range) {
  return {name, WholeNumbersValue{&v, range}};
}

/// The placeholder is the names unless there is another.
template <class Value>
OptionField field(const char* name, Value& v, const EnumNames<Value>& names, const char* placeholder = nullptr,
                  const char* help = "") {
  ChoiceValue choice{words_of(names), {}, {}};
  choice.place = [&v, names] {
    std::size_t i = 0;
    while (i < names.size() && !(names[i].first == v)) ++i;
    return i;
  };
  choice.set = [&v, names](std::size_t i) { v = names.at(i).first; };
  std::string words;
  for (const std::string& word : choice.names) words += (words.empty() ? "" : "|") + word;
  return {name, std::move(choice), placeholder == nullptr ? words : placeholder, help};
}

inline OptionField beside(OptionField field) {
  field.role = OptionRole::kBeside;
  return field;
}

}  // namespace cmap
