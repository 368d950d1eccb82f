#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cmap/align/pose_pairs.hpp"
#include "cmap/align/umeyama.hpp"

namespace cmap {

/// Moments of the positions of the pairs; with a mask, of those that it marks.
PairMoments center_moments(std::span<const PosePair> pairs, std::span<const std::uint8_t> mask = {});

/// Lengths of T source - target, m.
std::vector<double> center_distances(std::span<const PosePair> pairs, const Similarity& T);
double center_rmse_m(std::span<const PosePair> pairs, const Similarity& T);

/// A similarity and the pairs that it is the least-squares fit of.
struct RobustCenters {
  Similarity T;
  std::vector<std::uint8_t> fits;  ///< of each pair
  std::size_t n_misfits = 0;
};

/// Umeyama's fit on all pairs, unless some of them jump: where a fit of most of the path leaves a pair farther than 15
/// times the median distance and 1 % of the path's size, it is left out, and the rest is fitted again. The search for
/// that fit (least median of squares over random triples, a fixed seed) weighs the path by where it leads, not by how
/// long it stays. Fewer than 8 pairs are all taken. Throws as fit_similarity() does.
RobustCenters fit_most_centers(std::span<const PosePair> pairs, const ScaleModel& model);

}  // namespace cmap
