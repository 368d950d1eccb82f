#pragma once

#include <vector>

#include "cmap/align/verdict.hpp"
#include "pose_search.hpp"

namespace cmap {

/// A pose among others.
struct Finalists {
  JudgedPose best;
  std::vector<JudgedPose> rivals;         ///< distinct from it and each other, the best first
  std::vector<double> advantage;          ///< of the best over each rival, in standard errors
  Chance chance{};
};

/// Settles poses, and judges them at fine reach: the best by evidence first. `first`, where given, is taken as it is and
/// stays the best. Throws std::invalid_argument where there are none.
Finalists finalists_of(PoseSearch& search, const std::vector<JudgedPose>& poses, const Similarity* first = nullptr);

/// Whether one pose fits, and no other as well. Rivals in world frames with the search's origins.
Judgment judgment_of(const Finalists& finalists, const Eigen::Vector3d& source_origin,
                     const Eigen::Vector3d& target_origin);

}  // namespace cmap
