#include "trajectory/path_judgment.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cmap/core/error.hpp"
#include "direction_text.hpp"
#include "trajectory/residual_correlation.hpp"
#include "trajectory/robust_centers.hpp"

namespace cmap {
namespace {

constexpr double kLargestShareOfSpread = 0.5;  // published estimates: up to 0.11
constexpr double kLeastExplainedMotion = 0.6;  // published estimates: from 0.98 on
constexpr std::size_t kDisplacements = 20;
constexpr double kMirroredShare = 0.5;  // of the residual of the rotation
constexpr double kRounding = 1e-6;      // of the spread: smaller residuals say nothing
constexpr double kFreeTurn = 2.0;       // residuals; noise alone spreads by at most 0.82
constexpr double kWeakTurn = 3.0;
constexpr double kStandsStill = 0.01;  // of the other's spread

/// What the verdict rests on; RMSE and spreads in m of the target.
struct PathMeasures {
  double n = 0.0;
  double rmse_m = 0.0;       ///< of T
  double best_rmse_m = 0.0;  ///< of the least-squares fit of T's kind
  double free_rmse_m = 0.0;  ///< of that with scale
  double free_scale = 1.0;
  double mirrored_rmse_m = 0.0;
  double target_spread_m = 0.0, source_spread_m = 0.0;  ///< RMS about the mean; the source's in its own unit
  double across_m = 0.0;                                ///< of the scaled source, across `along`
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();     ///< the path's main direction, in the target's frame
  double explained_motion = 1.0;
};

/// How much of the displacements between poses along the path one similarity without its translation explains.
double explained_motion(std::span<const PosePair> pairs) {
  const std::size_t n = std::min(kDisplacements, pairs.size() - 1);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double sq_source = 0.0, sq_target = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const PosePair &from = pairs[i * (pairs.size() - 1) / n], &to = pairs[(i + 1) * (pairs.size() - 1) / n];
    const Eigen::Vector3d source = to.source.position - from.source.position;
    const Eigen::Vector3d target = to.target.position - from.target.position;
    cross += source * target.transpose();
    sq_source += source.squaredNorm();
    sq_target += target.squaredNorm();
  }
  if (!(sq_source > 0.0 && sq_target > 0.0)) return 0.0;
  const double agreement = best_agreement(cross, Handedness::kSame);
  return agreement * agreement / (sq_source * sq_target);
}

/// The main direction, and the spread across it, of the source as it lies in the target's frame.
void measure_shape(const PairMoments& moments, const Similarity& T, double scale, PathMeasures& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments.scatter_p / moments.weight);
  const Eigen::Vector3d variance = eigen.eigenvalues().cwiseMax(0.0);
  m.across_m = scale * std::sqrt(variance[0] + variance[1]);
  m.along = T.rotation * eigen.eigenvectors().col(2);
}

PathMeasures measure(std::span<const PosePair> pairs, const Similarity& T, bool with_scale) {
  const PairMoments moments = center_moments(pairs);
  PathMeasures m;
  m.n = moments.weight;
  const auto rmse = [&](double cost) { return std::sqrt(std::max(0.0, cost) / moments.weight); };
  const auto best = [&](const ScaleModel& model) { return fit_similarity(moments, model); };
  m.rmse_m = center_rmse_m(pairs, T);
  m.best_rmse_m = m.free_rmse_m = m.rmse_m;
  m.target_spread_m = rmse(moments.sq_q);
  m.source_spread_m = rmse(moments.scatter_p.trace());
  m.mirrored_rmse_m = rmse(reflection_cost(moments, with_scale));
  m.explained_motion = pairs.size() > 1 ? explained_motion(pairs) : 1.0;
  try {
    const Similarity rigid = best(ScaleModel::rigid()), free = best(ScaleModel::free());
    m.free_scale = free.scale;
    m.free_rmse_m = rmse(similarity_cost(moments, ScaleModel::free(), free));
    m.best_rmse_m = with_scale ? m.free_rmse_m : rmse(similarity_cost(moments, ScaleModel::rigid(), rigid));
    measure_shape(moments, T, free.scale, m);
  } catch (const UnsupportedError&) {
    // A first frame needs no fit.
  }
  return m;
}

bool is_mirrored(const PathMeasures& m) {
  return m.best_rmse_m > kRounding * m.target_spread_m && m.mirrored_rmse_m < kMirroredShare * m.best_rmse_m &&
         m.mirrored_rmse_m < kLargestShareOfSpread * m.target_spread_m;
}

bool is_alike(const PathMeasures& m) {
  if (m.rmse_m <= kRounding * m.target_spread_m) return true;
  return m.rmse_m <= kLargestShareOfSpread * m.target_spread_m && m.explained_motion >= kLeastExplainedMotion;
}

std::string why_not_alike(const PathMeasures& m) {
  const char* still = m.source_spread_m < kStandsStill * m.target_spread_m   ? "source"
                      : m.target_spread_m < kStandsStill * m.source_spread_m ? "target"
                                                                             : nullptr;
  std::string text = fmt::format("the paths do not fit: the RMSE is {:.3g} m on a path that spreads by {:.3g} m",
                                 m.rmse_m, m.target_spread_m);
  if (still != nullptr) {
    text += fmt::format("; the {} stands still beside the other (its poses spread by {:.3g})", still,
                        still[0] == 's' ? m.source_spread_m : m.target_spread_m);
  } else if (m.explained_motion < kLeastExplainedMotion) {
    text += fmt::format(", and {:.0f} % of its motion agrees with the source's", 100.0 * m.explained_motion);
  }
  return text;
}

std::string what_would_make_them_alike(const PathMeasures& m, TrajectoryFit fit) {
  const bool another_scale =
      m.free_rmse_m < 0.5 * m.rmse_m && m.free_rmse_m <= kLargestShareOfSpread * m.target_spread_m;
  if (fit != TrajectoryFit::kSim3 && another_scale && m.explained_motion >= kLeastExplainedMotion) {
    return fmt::format("--fit sim3 finds a scale of {:.6g} and an RMSE of {:.3g} m", m.free_scale, m.free_rmse_m);
  }
  return "are they of one body, with one clock? --time-offset estimate looks for another clock";
}

/// The residual without what the fit itself has taken: 7 of its numbers, or 6.
double residual_m(const PathMeasures& m, bool with_scale) {
  const double numbers = 3.0 * m.n;
  return m.free_rmse_m * std::sqrt(numbers / std::max(1.0, numbers - (with_scale ? 7.0 : 6.0)));
}

/// Whether the path is bent enough to hold the rotation about it.
void judge_turn(std::span<const PosePair> pairs, const Similarity& T, const PathMeasures& m, double residual_m,
                Judgment& judgment) {
  if (residual_m <= kRounding * m.target_spread_m || m.across_m >= kWeakTurn * residual_m) return;
  const std::string direction = direction_text(m.along);
  judgment.reason = fmt::format(
      "the path is straight but for {:.3g} m across {}, and the residual is {:.3g} m: the rotation about it is {}",
      m.across_m, direction, residual_m, m.across_m < kFreeTurn * residual_m ? "not determined" : "weakly determined");
  judgment.help = "a path with turns, or --fit first-frame";
  if (m.across_m < kFreeTurn * residual_m) {
    judgment.verdict = Verdict::kUnsupported;
    return;
  }
  judgment.verdict = Verdict::kWeak;
  const double error_rad = residual_m / std::sqrt(3.0 * m.n / alike_in_a_row(pairs, T)) / m.across_m;
  judgment.weak.push_back({"rotation about " + direction, error_rad * m.target_spread_m});
}

}  // namespace

Judgment judge_paths(std::span<const PosePair> pairs, const Similarity& T, TrajectoryFit fit) {
  const bool with_scale = fit == TrajectoryFit::kSim3;
  const PathMeasures m = measure(pairs, T, with_scale);
  Judgment judgment;
  const double share = m.target_spread_m > 0.0 ? m.rmse_m / m.target_spread_m : m.rmse_m > 0.0 ? 1.0 : 0.0;
  judgment.score = std::max(0.0, 1.0 - share * share);
  if (is_mirrored(m)) {
    judgment.verdict = Verdict::kMirrored;
    judgment.reason = fmt::format("a reflection fits better, with an RMSE of {:.3g} m in place of {:.3g} m",
                                  m.mirrored_rmse_m, m.best_rmse_m);
    judgment.help = "one of the two is in a left-handed frame: change the sign of one of its axes";
  } else if (!is_alike(m)) {
    judgment.verdict = Verdict::kUnsupported;
    judgment.reason = why_not_alike(m);
    judgment.help = what_would_make_them_alike(m, fit);
  } else {
    judgment.verdict = Verdict::kDetermined;
    judgment.reason =
        fmt::format("an RMSE of {:.3g} m on a path that spreads by {:.3g} m", m.rmse_m, m.target_spread_m);
    if (fit != TrajectoryFit::kFirstFrame) judge_turn(pairs, T, m, residual_m(m, with_scale), judgment);
  }
  return judgment;
}

}  // namespace cmap
