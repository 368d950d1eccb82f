#pragma once

#include <span>
#include <vector>

#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// A hypothesis from matched points, and how many matches it explains.
struct Hypothesis {
  Similarity T;
  std::size_t n_inliers = 0;
};

/// The transforms that the largest sets of mutually compatible matches (p_i -> q_i) give, best first, at most
/// `n_best`, different from each other. Two matches are compatible if they keep their distance up to tolerance_m (after
/// `scale`, where it is free up to 5 %). Second-order: pairs count by how many further matches both are compatible
/// with, so that chance agreements fall away.
std::vector<Hypothesis> compatible_hypotheses(std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3d> q,
                                              double scale, bool scale_is_free, double tolerance_m, std::size_t n_best);

/// Scales that many pairs of matches agree on (|q_i - q_j| / |p_i - p_j|), most votes first, at most n_best.
std::vector<double> voted_scales(std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3d> q,
                                 double shortest_m, std::size_t n_best);

}  // namespace cmap
