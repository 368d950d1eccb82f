#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// How the scale of a similarity enters
///   J(s, R, t) = sum_i w_i |q_i - (s R p_i + t)|^2 + lambda (s - s0)^2.
struct ScaleModel {
  bool is_free = true;     ///< false: s stays s0; with s0 = 1 the fit is a rigid motion, SE(3)
  double s0 = 1.0;         ///< the scale expected, or kept
  double lambda_m2 = 0.0;  ///< weight of the expectation; 0 gives Umeyama's Sim(3)

  static ScaleModel rigid() { return {false, 1.0, 0.0}; }
  static ScaleModel free() { return {}; }
};

/// What J depends on: weighted moments of the pairs about their means.
struct PairMoments {
  std::size_t n = 0;
  double weight = 0.0;                                  ///< sum w
  Eigen::Vector3d mean_p = Eigen::Vector3d::Zero();     ///< m
  Eigen::Vector3d mean_q = Eigen::Vector3d::Zero();     ///< m
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();      ///< H = sum w p~ q~^T, m^2
  Eigen::Matrix3d scatter_p = Eigen::Matrix3d::Zero();  ///< sum w p~ p~^T, m^2
  double sq_q = 0.0;                                    ///< sum w |q~|^2, m^2
};

/// The minimizer of J, in closed form: R from the singular value decomposition of H (Umeyama 1991; it does not depend
/// on s and lambda), s = (tr(R H) + lambda s0) / (sum w |p~|^2 + lambda), t = mean_q - s R mean_p. Thread-safe. Throws
/// UnsupportedError where the pairs do not determine it: fewer than 3 of positive weight, coincident points (no
/// rotation, no scale), collinear points (no rotation about their line), saying which direction is free.
Similarity fit_similarity(const PairMoments& moments, const ScaleModel& model);

/// J of any similarity.
double similarity_cost(const PairMoments& moments, const ScaleModel& model, const Similarity& T);

/// Whether a rotation is sought, or a reflection.
enum class Handedness { kSame, kMirrored };

/// The largest tr(R cross) of all rotations R, or of all reflections.
double best_agreement(const Eigen::Matrix3d& cross, Handedness handedness);

/// The least J of all reflections (det R = -1), each with its best t and, where it is free, s; lambda = 0. It is below
/// that of fit_similarity() where one of the two point sets is the other's mirror image, and the same where they are
/// flat.
double reflection_cost(const PairMoments& moments, bool scale_is_free);

/// The minimizer for points given as lists; `weights` empty means 1 for all. Throws std::invalid_argument where lengths
/// differ or a weight is negative or not finite.
Similarity umeyama(std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3d> q,
                   const ScaleModel& model = ScaleModel::free(), std::span<const double> weights = {});

/// A pair and its weight; weight 0: no pair.
struct WeightedPair {
  Eigen::Vector3d p, q;
  double weight;
};

namespace detail {

struct PairSums {
  std::size_t n = 0;
  double weight = 0.0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d q = Eigen::Vector3d::Zero();
  PairSums& operator+=(const PairSums& other);
};

struct CenteredSums {
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d scatter_p = Eigen::Matrix3d::Zero();
  double sq_q = 0.0;
  CenteredSums& operator+=(const CenteredSums& other);
};

}  // namespace detail

/// Moments of the pairs pair_at(0) ... pair_at(n - 1), in two passes, so that pairs far from the origin lose nothing.
/// Bitwise the same for any number of threads; pair_at must be thread-safe.
template <class PairAt>
PairMoments pair_moments(std::size_t n, PairAt&& pair_at) {
  constexpr std::size_t kChunk = 4096;
  const auto sums = ordered_sum<detail::PairSums>(n, kChunk, [&](std::size_t begin, std::size_t end) {
    detail::PairSums sum;
    for (std::size_t i = begin; i < end; ++i) {
      const WeightedPair pair = pair_at(i);
      if (pair.weight > 0.0) sum += {1, pair.weight, pair.weight * pair.p, pair.weight * pair.q};
    }
    return sum;
  });
  PairMoments moments;
  moments.n = sums.n;
  moments.weight = sums.weight;
  if (sums.n == 0) return moments;
  moments.mean_p = sums.p / sums.weight;
  moments.mean_q = sums.q / sums.weight;
  const auto centered = ordered_sum<detail::CenteredSums>(n, kChunk, [&](std::size_t begin, std::size_t end) {
    detail::CenteredSums sum;
    for (std::size_t i = begin; i < end; ++i) {
      const WeightedPair pair = pair_at(i);
      if (!(pair.weight > 0.0)) continue;
      const Eigen::Vector3d p = pair.p - moments.mean_p;
      const Eigen::Vector3d q = pair.q - moments.mean_q;
      const Eigen::Vector3d weighted_p = pair.weight * p;
      sum.cross += weighted_p * q.transpose();
      sum.scatter_p += weighted_p * p.transpose();
      sum.sq_q += pair.weight * q.squaredNorm();
    }
    return sum;
  });
  moments.cross = centered.cross;
  moments.scatter_p = centered.scatter_p;
  moments.sq_q = centered.sq_q;
  return moments;
}

}  // namespace cmap
