#pragma once

#include <string>
#include <vector>

#include "cmap/core/options.hpp"

namespace cmap {

/// Whether it needs no value on a command line.
bool is_flag(const OptionField& field);

/// Sets a field from the text of a command line: "0.2,0.1", "true". Throws UsageError that names field, text and rule.
void set_from_text(const OptionField& field, const std::string& text);

/// The other way: the value as one would type it, empty for none.
std::string value_text(const OptionField& field);

/// The arguments that set those fields that differ from others of the same struct: "--lcr-radius", "0.5".
std::vector<std::string> arguments_for(const OptionFields& fields, const OptionFields& others);

}  // namespace cmap
