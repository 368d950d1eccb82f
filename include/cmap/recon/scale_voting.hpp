#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/recon/overlap_scale.hpp"

namespace cmap {

/// What a session's camera poses say of its scale.
struct SessionScale {
  double scale = 1.0;
  double linearity = 0.0;    ///< of its path, 0..1
  double sigma_log = 0.005;  ///< standard deviation of log scale
  bool is_usable = true;     ///< false: no baseline; the scale comes from the neighbors
};

enum class ScaleVoting {
  kRobust,  ///< exhaustive on chain-normalized log scales, all scales corrected at once
  kPaper,   ///< sampled on plain scales, outliers replaced one by one
};

struct ScaleVotingOptions {
  ScaleVoting mode = ScaleVoting::kRobust;
  int seed = 0;                     ///< kPaper: of the draws
  int draws = 100;                  ///< kPaper
  double deviations = 2.0;          ///< kPaper: the tolerance, in standard deviations of the scales
  double robust_deviations = 3.0;   ///< kRobust: the tolerance, in 1.4826 MAD of the log scales
  double least_tolerance = 1.02;    ///< kRobust: factors up to this are no outliers
  double unlinked_tolerance = 1.2;  ///< kRobust: the same where sessions without overlap are compared
  int min_voters = 4;               ///< kRobust: fewer cannot vote
  double cauchy_width = 2.0;        ///< kRobust: of the correction, in standard deviations
  double least_sigma_log = 0.005;   ///< kRobust: of log scales and log ratios
  double max_alpha = 50.0;          ///< of the softmax
  double equal_share = 1e-3;        ///< std / mean below which all scales are one
};

struct VotedScales {
  std::vector<double> scales;    ///< of every session, corrected
  std::vector<char> is_inlier;   ///< what the vote said; false for unusable sessions
  std::vector<double> compared;  ///< kRobust: chain-normalized log scales u_k; kPaper: the scales. NaN: unusable
  std::vector<double> weights;   ///< the softmax p_k; 0 for unusable sessions
  std::size_t winner = 0;        ///< the candidate that the vote chose
  double tolerance = 0.0;        ///< on differences of `compared`
  double alpha = 0.0;            ///< of the softmax
  std::vector<std::string> warnings;
};

/// Scales of K sessions made consistent. `ratios`: s_{k+1} / s_k for k = 0 ... K - 2, none where sessions do not
/// overlap.
///
/// kPaper: tolerance `deviations` std(s) (of the population), candidates drawn with softmax(alpha l_k), alpha =
/// mean(s) / std(s); the one with most |s_k - s_c| <= tolerance wins, and every outlier takes the scale of the nearest
/// inlier times the ratios along the way (of two equally near ones, the geometric mean).
/// kRobust: u_k = log s_k - sum_{j<k} log r_j is the same for all good sessions. Every session is a candidate; its
/// score is the sum of the weights of |u_k - u_c| <= max(robust_deviations * 1.4826 MAD, log least_tolerance), of equal
/// scores the smaller spread wins. Fewer than min_voters cannot vote: the most certain one is the candidate, with the
/// least tolerance. Then
///   sum a_k rho(log s_k - z_k) + sum b_k (log s_{k+1} - log s_k - log r_k)^2
/// is minimized, z_k the measured log scale, a_k = 1 / max(sigma, least_sigma_log)^2 (0 for outliers), b_k = 1 /
/// (sigma_r^2 + least_sigma_log^2), rho Cauchy: reweighted least squares on a tridiagonal system, from every candidate,
/// the lowest kept.
/// Both: one session is accepted; std / mean < equal_share makes all inliers; alpha is at most max_alpha. Sessions that
/// nothing usable is linked to keep their own scale, or take the median of the usable ones where they have none, with a
/// warning. Deterministic; thread-safe. Throws std::invalid_argument where a scale, a ratio or their number is wrong,
/// UsageError for options, UnsupportedError where no session is usable.
VotedScales vote_scales(std::span<const SessionScale> sessions, std::span<const std::optional<ScaleRatio>> ratios,
                        const ScaleVotingOptions& options = {});

}  // namespace cmap
