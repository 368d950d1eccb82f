#pragma once

#include <set>
#include <string>

namespace cmap {

/// Whether an option of an evaluation, by its name in reports, bears on one of these metrics. Options that are about no
/// metric in particular bear on all.
bool bears_on(const std::string& parameter, const std::set<std::string>& metrics);

}  // namespace cmap
