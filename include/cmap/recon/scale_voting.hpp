#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/recon/overlap_scale.hpp"

namespace cmap {

/// What registration says of one session's scale.
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
  std::uint64_t seed = 0;           ///< kPaper: of the draws
  int draws = 100;                  ///< kPaper
  double least_tolerance = 1.02;    ///< kRobust: factors up to this are no outliers
  double unlinked_tolerance = 1.2;  ///< kRobust: the same where sessions without overlap are compared
  double cauchy_width = 2.0;        ///< kRobust: of the correction, in standard deviations
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
/// kPaper: tolerance 2 std(s) (of the population), candidates drawn with softmax(alpha l_k), alpha = mean(s) / std(s);
/// the one with most |s_k - s_c| <= tolerance wins, and every outlier takes the scale of the nearest inlier times the
/// ratios along the way (of two equally near ones, the geometric mean).
/// kRobust: u_k = log s_k - sum_{j<k} log r_j is the same for all good sessions. Every session is a candidate; its
/// score is the sum of the weights of |u_k - u_c| <= max(3 * 1.4826 MAD, log 1.02), of equal scores the smaller spread
/// wins. Fewer than four sessions cannot vote: the most certain one is the candidate, tolerance log 1.02. Then
///   sum a_k rho(log s_k - z_k) + sum b_k (log s_{k+1} - log s_k - log r_k)^2
/// is minimized, z_k the measured log scale, a_k = 1 / max(sigma, 0.005)^2 (0 for outliers), b_k = 1 / (sigma_r^2 +
/// 0.005^2), rho Cauchy: reweighted least squares on a tridiagonal system, from every candidate, the lowest kept.
/// Both: one session is accepted; std / mean < 1e-3 makes all inliers; alpha is at most 50. Sessions that nothing
/// usable is linked to keep their own scale, or take the median of the usable ones where they have none, with a
/// warning. Deterministic; thread-safe. Throws std::invalid_argument where a scale, a ratio or their number is wrong,
/// UsageError for options, UnsupportedError where no session is usable.
VotedScales vote_scales(std::span<const SessionScale> sessions, std::span<const std::optional<ScaleRatio>> ratios,
                        const ScaleVotingOptions& options = {});

}  // namespace cmap
