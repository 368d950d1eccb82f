#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace cmap {

struct NamedRecord;
struct RecordRows;

/// A number that stands in a record by its name: a value (NaN: missing), a count, a word, several values.
struct Number {
  std::string name;
  std::variant<double, std::uint64_t, std::string, std::vector<double>> value;
};

/// What was found of one metric, or of a part of it; reports hold the same tree as JSON. Units are the metric's unless
/// a number's name ends in its own.
struct Record {
  std::optional<double> threshold_m = {};  ///< where it is one of per_threshold
  std::optional<double> value = {};        ///< NaN: nothing qualified; none: the record has no single value
  std::vector<Number> numbers = {};        ///< beside the value
  std::vector<Number> parameters = {};     ///< that the value depends on
  std::vector<NamedRecord> parts = {};     ///< a direction, the reference's own
  std::vector<RecordRows> rows = {};       ///< per_threshold, per_range, a distribution

  Record& add(std::string name, double number);
  Record& add(std::string name, std::uint64_t count);
  Record& add(std::string name, const char* word);
  Record& add(std::string name, std::vector<double> numbers);
  Record& add(std::string name, Record part);
  Record& add(std::string name, std::vector<Record> list);

  /// The list of that name, empty if there is none.
  const std::vector<Record>& list(std::string_view name) const&;
  std::vector<Record>& list_to_change(std::string_view name);  ///< throws std::out_of_range if there is none
  /// Of a record that does not stay.
  std::vector<Record> list(std::string_view name) && { return std::as_const(*this).list(name); }
  /// The part of that name, nullptr if there is none.
  const Record* part(std::string_view name) const;
  Record& part_to_change(std::string_view name);  ///< throws std::out_of_range if there is none
  /// The number at "value", "name", "part.name" or "list.3.name"; nullopt where there is none, NaN where it is missing.
  std::optional<double> number(std::string_view path) const;
};

struct NamedRecord {
  std::string name;
  Record record;
};

struct RecordRows {
  std::string name;
  std::vector<Record> rows;
};

}  // namespace cmap
