#pragma once

#include <vector>

#include "cmap/align/alignment.hpp"
#include "global/pose_search.hpp"

namespace cmap {

/// A pose among others.
struct Finalists {
  JudgedPose best;
  std::vector<JudgedPose> rivals;  ///< distinct from it and each other, the best first
  std::vector<double> advantage;   ///< of the best over each rival, in standard errors
};

/// Settles poses and judges them: the best by evidence first. `first`, where given, is taken as it is and stays the
/// best. Throws std::invalid_argument where there are none.
Finalists finalists_of(PoseSearch& search, const std::vector<JudgedPose>& poses, const Similarity* first = nullptr);

/// How well a pose fits, from how it agrees at ever finer reach.
struct Fit {
  Worth worth;
  /// Of the score that another sample of the same map would have: at an eighth and a sixteenth of the search's voxel.
  double relative_8 = 0.0, relative_16 = 0.0;
  double explained = 0.0;  ///< share of both maps' witnesses that agree beyond chance
  bool convinces() const;
};
Fit fit_at(PoseSearch& search, const Similarity& local);

/// The verdict on a pose: whether it fits, and no rival, and no mirror image, as well.
Judgment judgment_of(PoseSearch& search, const Similarity& local, const Finalists& finalists,
                     const Eigen::Vector3d& source_origin, const Eigen::Vector3d& target_origin);

/// Directions along which the alignment is so uncertain that it is to be said, into a judgment that it fits.
void tell_weak(const Alignment& found, Judgment& judgment);

/// The verdict on what a registration from a start found: other poses are searched to compare with.
Judgment judge_alignment(const PointCloud& source, const PointCloud& target, const Alignment& found);

}  // namespace cmap
