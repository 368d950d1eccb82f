#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cmap/eval/evaluation.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

/// The layers that say most about a pair: both maps, local color recall where it was computed, and the distance of
/// colors, or in space where there are none.
std::vector<std::string> standard_panels(const EvaluatedPair& evaluation);

/// Writes those panels from an oblique view. Throws UsageError where `name` is no picture's.
void write_standard_figure(const EvaluatedPair& evaluation, const std::filesystem::path& name, OutputFile& file);

}  // namespace cmap
