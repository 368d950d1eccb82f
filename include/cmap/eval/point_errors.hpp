#pragma once

#include "cmap/eval/evaluation.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

/// Writes the estimate as it was compared (moved, cropped, thinned; its own order) as PLY with float properties that
/// CloudCompare shows as scalar fields: scalar_distance_m to the nearest reference point and, where both maps have
/// color, scalar_color_distance (unit RGB; NaN where either point has none). The caller commits the file.
void write_estimate_errors(const EvaluatedPair& evaluation, OutputFile& file);

/// The same for the reference, with scalar_lcr where local color recall was computed: 0 not covered, 1 covered but of
/// the wrong color, 2 recalled, 3 without a color of its own.
void write_reference_errors(const EvaluatedPair& evaluation, OutputFile& file);

}  // namespace cmap
