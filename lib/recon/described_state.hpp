#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

/// One description of a struct, a template `describe(fields, struct)` beside it, serves writing it as JSON and reading
/// it back to the bit.
namespace cmap {

/// What a description gets of its struct: only a reader may change it.
template <class Fields, class State>
using StateOf = std::conditional_t<Fields::kReads, State, const State>;

template <class Fields, class State>
concept DescribedFor = requires(Fields& fields, StateOf<Fields, State>& state) {
  describe(fields, state);
};

/// Writes every field by its name: numbers, texts, described structs, matrices and poses (by columns), lists of these,
/// null for an optional without value.
class StateWriter {
 public:
  static constexpr bool kReads = false;
  using Json = nlohmann::ordered_json;

  template <class T>
  void field(const char* key, const T& value) {
    json_[key] = written(value);
  }
  /// NaN, which JSON does not know, is null.
  void field_or_nan(const char* key, double value) { json_[key] = std::isnan(value) ? Json(nullptr) : Json(value); }
  /// Follows from other fields: for people, and not read.
  void derived(const char* key, double value) { json_[key] = value; }

  template <class T>
  static Json written(const T& value) {
    if constexpr (DescribedFor<StateWriter, T>) {
      StateWriter writer;
      describe(writer, value);
      return std::move(writer.json_);
    } else {
      return value;
    }
  }
  template <class T>
  static Json written(const std::vector<T>& list) {
    Json json = Json::array();
    for (const T& value : list) json.push_back(written(value));
    return json;
  }
  template <class T>
  static Json written(const std::optional<T>& value) {
    return value ? written(*value) : Json(nullptr);
  }
  template <int kRows, int kColumns>
  static Json written(const Eigen::Matrix<double, kRows, kColumns>& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  }
  static Json written(const Eigen::Isometry3d& pose) { return written(pose.matrix()); }

 private:
  Json json_ = Json::object();
};

/// Reads what StateWriter has written. Throws nlohmann's exceptions or std::invalid_argument for anything else: fields
/// that are missing or too many, another type, a number that is none, a matrix of another size.
class StateReader {
 public:
  static constexpr bool kReads = true;
  using Json = nlohmann::ordered_json;

  template <class T>
  void field(const char* key, T& value) {
    read(next(key), value);
  }
  void field_or_nan(const char* key, double& value) {
    const Json& json = next(key);
    value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
  }
  void derived(const char* key, double) { next(key); }

  template <class T>
  static void read(const Json& json, T& value) {
    if constexpr (DescribedFor<StateReader, T>) {
      StateReader reader(json);
      describe(reader, value);
      require(reader.n_read_ == json.size(), "a field that nobody reads");
    } else if constexpr (std::integral<T> && !std::same_as<T, bool>) {
      require(std::unsigned_integral<T> ? json.is_number_unsigned() : json.is_number_integer(), "not a whole number");
      value = json.get<T>();
    } else {
      value = json.get<T>();
    }
  }
  template <class T>
  static void read(const Json& json, std::vector<T>& list) {
    require(json.is_array(), "not a list");
    list.clear();
    for (const Json& item : json) read(item, list.emplace_back());
  }
  template <class T>
  static void read(const Json& json, std::optional<T>& value) {
    value.reset();
    if (!json.is_null()) read(json, value.emplace());
  }
  template <int kRows, int kColumns>
  static void read(const Json& json, Eigen::Matrix<double, kRows, kColumns>& matrix) {
    std::vector<double> values;
    read(json, values);
    require(values.size() == static_cast<std::size_t>(matrix.size()), "a matrix of another size");
    std::ranges::copy(values, matrix.data());
  }
  static void read(const Json& json, Eigen::Isometry3d& pose) { read(json, pose.matrix()); }

 private:
  explicit StateReader(const Json& object) : object_(object) {}

  const Json& next(const char* key) {
    ++n_read_;
    return object_.at(key);
  }
  static void require(bool holds, const char* fault) {
    if (!holds) throw std::invalid_argument(fault);
  }

  const Json& object_;
  std::size_t n_read_ = 0;
};

/// As JSON.
template <class State>
nlohmann::ordered_json state_json(const State& state) {
  return StateWriter::written(state);
}

/// From what state_json() gave; none from anything else.
template <class State>
std::optional<State> state_from(const nlohmann::ordered_json& json) {
  State state;
  try {
    StateReader::read(json, state);
  } catch (const nlohmann::ordered_json::exception&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return state;
}

}  // namespace cmap
