#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cmap/core/options.hpp"

namespace cmap {

/// Sets the fields that a JSON object names; those of a refused one and after it stay. Throws UsageError "where: name:
/// value and reason" for an unknown name, a wrong type and a value out of its range; `where` may be empty.
void set_from_json(const OptionFields& fields, const nlohmann::ordered_json& object, const std::string& where = "");

/// The same of one field's value.
void set_from_json(const OptionField& field, const nlohmann::ordered_json& value, const std::string& where = "");

/// Every field by its name: set_from_json() of it gives the same values.
nlohmann::ordered_json options_json(const OptionFields& fields);
nlohmann::ordered_json value_json(const OptionField& field);

/// The same of a struct that an option_fields() describes.
template <class Options>
nlohmann::ordered_json options_json_of(Options options) {
  return options_json(option_fields(options));
}

/// An option as a command line sets it.
struct OptionAssignment {
  std::string name;
  nlohmann::ordered_json value;  ///< a text where it is no JSON
};

/// Throws UsageError unless it has the form "name=value", which the message calls `form`.
OptionAssignment read_assignment(const std::string& assignment, const char* form);

}  // namespace cmap
