#pragma once

#include <filesystem>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

/// Where the maps' boxes are apart, no transform moved the estimate, and a shift that one of the files' comments or a
/// file beside names (find_shift_hints()) brings them together: a warning "shift_found" with the transform that applies
/// it. Nothing is applied.
void warn_about_shifts(EvaluatedPair& evaluation, const std::filesystem::path& reference,
                       const std::filesystem::path& estimate);

}  // namespace cmap
