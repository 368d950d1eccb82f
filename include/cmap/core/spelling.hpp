#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// ASCII letters small.
std::string lower_case(std::string_view text);

/// Insertions, deletions, replacements and swaps of neighbors that make one word of the other, whatever their case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// For the end of a message about a name that is unknown: "; did you mean accuracy?", or nothing where no known name is
/// near. Near is a third of the letters off, or a longer name with that beginning.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

/// "is none of accuracy, fitness; did you mean accuracy?"
std::string is_none_of(std::string_view word, const std::vector<std::string>& known);

}  // namespace cmap
