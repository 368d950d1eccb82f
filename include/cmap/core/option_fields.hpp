#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"

/// One description of an options struct, a template called with one of three visitors, serves reading it from JSON,
/// writing it, and checking values that were set in code.
namespace cmap {

/// Values that a number may have.
struct NumberRange {
  double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
  bool above_low = false;  ///< `low` itself is no value

  bool holds(double v) const { return std::isfinite(v) && v <= high && (above_low ? v > low : v >= low); }
  std::string text() const {
    constexpr double kFar = std::numeric_limits<double>::max();
    if (low == -kFar) return "must be a finite number";
    const std::string lower = fmt::format("must be {} {}", above_low ? "above" : "at least", low);
    return high == kFar ? lower : fmt::format("{} and at most {}", lower, high);
  }
};

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.low = 0.0, .above_low = true};
inline constexpr NumberRange kNotNegative{.low = 0.0};
inline constexpr NumberRange kFraction{.low = 0.0, .high = 1.0};

/// A name for every value of an enumeration.
template <class Enum>
using EnumNames = std::vector<std::pair<Enum, const char*>>;

/// Throws UsageError for a value out of its range.
class FieldChecker {
 public:
  static constexpr bool kChanges = false;

  explicit FieldChecker(std::string where) : where_(std::move(where)) {}

  void field(const char* key, double value, const NumberRange& range = kAnyNumber) const {
    if (!range.holds(value)) refuse(key, fmt::format("{} {}", value, range.text()));
  }
  void field(const char* key, int value, const NumberRange& range) const {
    field(key, static_cast<double>(value), range);
  }
  void field(const char*, bool) const {}
  void field(const char*, const std::string&) const {}
  void field(const char* key, const Eigen::Vector3d& value) const {
    for (const double v : value) field(key, v);
  }
  void field(const char* key, const Eigen::Vector2d& value) const {
    for (const double v : value) field(key, v);
  }
  void field(const char* key, const std::vector<double>& list, const NumberRange& range) const {
    for (const double v : list) field(key, v, range);
  }
  void field(const char* key, const std::vector<int>& list, const NumberRange& range) const {
    for (const int v : list) field(key, v, range);
  }
  template <class Enum>
  void field(const char* key, Enum value, const EnumNames<Enum>& names) const {
    for (const auto& [known, name] : names) {
      if (known == value) return;
    }
    refuse(key, "has no such value");
  }

 private:
  [[noreturn]] void refuse(const char* key, const std::string& reason) const {
    throw UsageError(fmt::format("{}: {}: {}", where_, key, reason));
  }
  std::string where_;
};

/// Sets the fields that a JSON object names. Throws UsageError for a wrong type and a value out of its range;
/// finish() for a key that no field has.
class FieldReader {
 public:
  static constexpr bool kChanges = true;
  using Json = nlohmann::ordered_json;

  FieldReader(const Json& object, std::string where) : object_(object), where_(std::move(where)), check_(where_) {
    if (!object_.is_object()) throw UsageError(fmt::format("{}: expected a JSON object of options", where_));
  }

  void field(const char* key, double& value, const NumberRange& range = kAnyNumber) {
    if (const Json* json = find(key)) value = number(key, *json, range);
  }
  void field(const char* key, int& value, const NumberRange& range) {
    if (const Json* json = find(key)) value = whole_number(key, *json, range);
  }
  void field(const char* key, bool& value) {
    if (const Json* json = find(key)) {
      if (!json->is_boolean()) refuse(key, *json, "is neither true nor false");
      value = json->get<bool>();
    }
  }
  void field(const char* key, std::string& value) {
    if (const Json* json = find(key)) {
      if (!json->is_string()) refuse(key, *json, "is not a text");
      value = json->get<std::string>();
    }
  }
  void field(const char* key, Eigen::Vector3d& value) { fixed(key, value); }
  void field(const char* key, Eigen::Vector2d& value) { fixed(key, value); }
  void field(const char* key, std::vector<double>& list, const NumberRange& range) {
    if (const Json* json = find(key)) {
      list.clear();
      for (const Json& item : array(key, *json)) list.push_back(number(key, item, range));
    }
  }
  void field(const char* key, std::vector<int>& list, const NumberRange& range) {
    if (const Json* json = find(key)) {
      list.clear();
      for (const Json& item : array(key, *json)) list.push_back(whole_number(key, item, range));
    }
  }
  template <class Enum>
  void field(const char* key, Enum& value, const EnumNames<Enum>& names) {
    const Json* json = find(key);
    if (json == nullptr) return;
    std::vector<std::string> known;
    for (const auto& [item, name] : names) {
      if (*json == name) {
        value = item;
        return;
      }
      known.emplace_back(name);
    }
    refuse(key, *json, is_none_of(json->is_string() ? json->get<std::string>() : "", known));
  }

  void finish() const {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        throw UsageError(fmt::format("{}: unknown key \"{}\"{}", where_, key, did_you_mean(key, known_)));
      }
    }
  }

 private:
  const Json* find(const char* key) {
    known_.emplace_back(key);
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  double number(const char* key, const Json& json, const NumberRange& range) const {
    if (!json.is_number()) refuse(key, json, "is not a number");
    check_.field(key, json.get<double>(), range);
    return json.get<double>();
  }
  int whole_number(const char* key, const Json& json, const NumberRange& range) const {
    const double value = number(key, json, range);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
      refuse(key, json, "is not a whole number");
    }
    return static_cast<int>(value);
  }
  const Json& array(const char* key, const Json& json) const {
    if (!json.is_array()) refuse(key, json, "is not a list of numbers");
    return json;
  }
  template <class Vector>
  void fixed(const char* key, Vector& value) {
    const Json* json = find(key);
    if (json == nullptr) return;
    constexpr auto kSize = static_cast<std::size_t>(Vector::RowsAtCompileTime);
    if (array(key, *json).size() != kSize) refuse(key, *json, fmt::format("is not a list of {} numbers", kSize));
    for (std::size_t i = 0; i < kSize; ++i) value[static_cast<int>(i)] = number(key, (*json)[i], kAnyNumber);
  }
  [[noreturn]] void refuse(const char* key, const Json& json, const std::string& reason) const {
    throw UsageError(fmt::format("{}: {}: {} {}", where_, key, json.dump(), reason));
  }

  const Json& object_;
  std::string where_;
  FieldChecker check_;
  std::vector<std::string> known_;
};

/// Every field by its name.
class FieldWriter {
 public:
  static constexpr bool kChanges = false;
  using Json = nlohmann::ordered_json;

  void field(const char* key, double value, const NumberRange& = kAnyNumber) { json_[key] = value; }
  void field(const char* key, int value, const NumberRange&) { json_[key] = value; }
  void field(const char* key, bool value) { json_[key] = value; }
  void field(const char* key, const std::string& value) { json_[key] = value; }
  void field(const char* key, const std::vector<double>& list, const NumberRange&) { json_[key] = list; }
  void field(const char* key, const std::vector<int>& list, const NumberRange&) { json_[key] = list; }
  template <class Enum>
  void field(const char* key, Enum value, const EnumNames<Enum>& names) {
    for (const auto& [item, name] : names) {
      if (item == value) json_[key] = name;
    }
  }
  void field(const char* key, const Eigen::Vector3d& v) { json_[key] = {v.x(), v.y(), v.z()}; }
  void field(const char* key, const Eigen::Vector2d& v) { json_[key] = {v.x(), v.y()}; }

  Json finish() { return std::move(json_); }

 private:
  Json json_ = Json::object();
};

/// What a description gets of an options struct: only a reader may change it.
template <class Fields, class Options>
using FieldsOf = std::conditional_t<Fields::kChanges, Options, const Options>;

/// An option as a command line sets it.
struct OptionAssignment {
  std::string name;
  nlohmann::ordered_json value;  ///< a text where it is no JSON
};

/// Throws UsageError unless it has the form "name=value", which the message calls `form`.
inline OptionAssignment read_assignment(const std::string& assignment, const char* form) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("\"{}\" is not {}", assignment, form));
  }
  const std::string text = assignment.substr(equals + 1);
  auto value = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  return {assignment.substr(0, equals), value.is_discarded() ? nlohmann::ordered_json(text) : std::move(value)};
}

}  // namespace cmap
