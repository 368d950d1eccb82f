#pragma once

#include <vector>

#include "cmap/geometry/similarity.hpp"
#include "global/column_map.hpp"

namespace cmap {

/// A pose that columns speak for.
struct ColumnPose {
  Similarity local;    ///< from the source's points to the target's, as both maps were given them
  double score = 0.0;  ///< sum of the word scores of the cells in common
};

/// The poses that turn the source about the vertical and shift it so that its columns fit the target's best, over all
/// turns and shifts, the best first, at most n_best, each at least three cells or two steps of the turn from those
/// before. `mirrored`: of the source's mirror image (upright, x turned round); then `local` holds an improper rotation.
std::vector<ColumnPose> search_columns(const ColumnMap& source, const ColumnMap& target, const WordScores& scores,
                                       bool mirrored, std::size_t n_best);

}  // namespace cmap
