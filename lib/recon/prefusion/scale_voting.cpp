#include "cmap/recon/scale_voting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "prefusion/scale_correction.hpp"
#include "scale_correction.hpp"

namespace cmap {
namespace {

using Sessions = std::span<const SessionScale>;
using Ratios = std::span<const std::optional<ScaleRatio>>;

void check(Sessions sessions, Ratios ratios, const ScaleVotingOptions& options) {
  if (ratios.size() + 1 != std::max<std::size_t>(sessions.size(), 1)) {
    throw std::invalid_argument(fmt::format("vote_scales: {} ratios for {} sessions", ratios.size(), sessions.size()));
  }
  for (const SessionScale& s : sessions) {
    if (!s.is_usable) continue;
    if (!(s.scale > 0.0) || !std::isfinite(s.scale) || !std::isfinite(s.linearity) || !(s.sigma_log >= 0.0)) {
      throw std::invalid_argument(fmt::format("vote_scales: a session has the scale {:g}, linearity {:g}, sigma {:g}",
                                              s.scale, s.linearity, s.sigma_log));
    }
  }
  for (const auto& r : ratios) {
    if (r && (!(r->ratio > 0.0) || !std::isfinite(r->ratio) || !(r->sigma_log >= 0.0))) {
      throw std::invalid_argument(fmt::format("vote_scales: the ratio {:g}, sigma {:g}", r->ratio, r->sigma_log));
    }
  }
  if (options.draws < 1) throw UsageError(fmt::format("draws is {}: at least 1 expected", options.draws));
  for (const double factor : {options.least_tolerance, options.unlinked_tolerance}) {
    if (!(factor > 1.0)) throw UsageError(fmt::format("the tolerance is a factor of {:g}: above 1 expected", factor));
  }
  for (const auto& [name, value] :
       {std::pair("cauchy_width", options.cauchy_width), std::pair("least_sigma_log", options.least_sigma_log)}) {
    if (!(value > 0.0)) throw UsageError(fmt::format("{} is {:g}: positive expected", name, value));
  }
}

double log_ratio(const std::optional<ScaleRatio>& ratio) { return ratio ? std::log(ratio->ratio) : 0.0; }

/// One vote: what the usable sessions say, and who they are.
class Vote {
 public:
  Vote(Sessions sessions, const ScaleVotingOptions& options) : sessions_(sessions), options_(options) {
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      if (sessions[k].is_usable) voters_.push_back(k);
    }
    if (voters_.empty()) throw UnsupportedError("no session has a baseline: the scale is not determined");
    result_.is_inlier.assign(sessions.size(), 0);
    result_.weights.assign(sessions.size(), 0.0);
    result_.compared.assign(sessions.size(), NAN);
  }

  /// The paper's, on plain scales.
  VotedScales sampled() {
    for (const std::size_t k : voters_) result_.compared[k] = sessions_[k].scale;
    const Spread spread = weigh(result_.compared);
    // A pair is exactly two deviations apart, the default: the tolerance must not lose to rounding.
    result_.tolerance = options_.deviations * spread.std * (1.0 + 1e-12);
    if (is_equal(spread)) return all_inliers();
    std::mt19937_64 random(static_cast<std::uint64_t>(options_.seed));
    std::size_t most = 0;
    for (int draw = 0; draw < options_.draws; ++draw) {
      const std::size_t candidate = drawn(static_cast<double>(random() >> 11) * 0x1p-53);
      const std::vector<std::size_t> inliers = inliers_of(candidate);
      if (inliers.size() > most) {
        most = inliers.size();
        result_.winner = candidate;
      }
    }
    return finished();
  }

  /// On log scales freed of what the overlaps say about them.
  VotedScales exhaustive(Ratios ratios) {
    double chain = 0.0;
    bool linked = true;
    for (std::size_t k = 0; k < sessions_.size(); ++k) {
      if (k > 0) chain += log_ratio(ratios[k - 1]);
      if (k > 0 && !ratios[k - 1]) linked = false;
      if (sessions_[k].is_usable) result_.compared[k] = std::log(sessions_[k].scale) - chain;
    }
    if (!linked)
      result_.warnings.emplace_back("some neighboring sessions do not overlap: taken to have equal units in the vote");
    std::vector<double> u = voted(result_.compared);
    const double center = median(u);
    std::vector<double> relative(sessions_.size(), NAN);
    for (const std::size_t k : voters_) relative[k] = std::exp(result_.compared[k] - center);
    const Spread spread = weigh(relative);
    const double least = std::log(linked ? options_.least_tolerance : options_.unlinked_tolerance);
    const bool few = std::ssize(voters_) < options_.min_voters;
    result_.tolerance = few ? least : std::max(options_.robust_deviations * robust_sigma(u, center), least);
    if (is_equal(spread)) return all_inliers();
    result_.winner = few ? most_certain() : best_candidate();
    return finished();
  }

 private:
  struct Spread {
    double mean, std;
  };
  bool is_equal(const Spread& spread) const { return !(spread.std / spread.mean >= options_.equal_share); }

  std::vector<double> voted(const std::vector<double>& values) const {
    std::vector<double> chosen;
    for (const std::size_t k : voters_) chosen.push_back(values[k]);
    return chosen;
  }

  /// Mean and deviation of positive values, and from them the softmax of linearities.
  Spread weigh(const std::vector<double>& values) {
    const auto n = static_cast<double>(voters_.size());
    double mean = 0.0, variance = 0.0;
    for (const std::size_t k : voters_) mean += values[k] / n;
    for (const std::size_t k : voters_) variance += (values[k] - mean) * (values[k] - mean) / n;
    const Spread spread{mean, std::sqrt(variance)};
    result_.alpha = is_equal(spread) ? options_.max_alpha : std::min(spread.mean / spread.std, options_.max_alpha);
    double straightest = -std::numeric_limits<double>::infinity(), sum = 0.0;
    for (const std::size_t k : voters_) straightest = std::max(straightest, sessions_[k].linearity);
    for (const std::size_t k : voters_) {
      result_.weights[k] = std::exp(result_.alpha * (sessions_[k].linearity - straightest));
      sum += result_.weights[k];
    }
    for (double& weight : result_.weights) weight /= sum;
    return spread;
  }

  std::size_t drawn(double share) const {
    double sum = 0.0;
    for (const std::size_t k : voters_) {
      sum += result_.weights[k];
      if (share < sum) return k;
    }
    return voters_.back();
  }

  std::vector<std::size_t> inliers_of(std::size_t candidate) const {
    std::vector<std::size_t> inliers;
    for (const std::size_t k : voters_) {
      if (std::abs(result_.compared[k] - result_.compared[candidate]) <= result_.tolerance) inliers.push_back(k);
    }
    return inliers;
  }

  std::size_t best_candidate() const {
    std::size_t best = voters_.front();
    double best_score = -1.0, best_spread = 0.0;
    for (const std::size_t candidate : voters_) {
      double score = 0.0, spread = 0.0;
      const std::vector<std::size_t> inliers = inliers_of(candidate);
      for (const std::size_t k : inliers) {
        score += result_.weights[k];
        spread += std::pow(result_.compared[k] - result_.compared[candidate], 2) / static_cast<double>(inliers.size());
      }
      constexpr double kTie = 1e-12;  // sums of the same weights in another order
      if (score > best_score + kTie || (score > best_score - kTie && spread < best_spread)) {
        best = candidate;
        best_score = score;
        best_spread = spread;
      }
    }
    return best;
  }

  std::size_t most_certain() const {
    return *std::ranges::min_element(voters_, {}, [&](std::size_t k) {
      return std::pair(std::max(sessions_[k].sigma_log, options_.least_sigma_log), -sessions_[k].linearity);
    });
  }

  VotedScales all_inliers() {
    result_.winner = *std::ranges::max_element(voters_, {}, [&](std::size_t k) { return result_.weights[k]; });
    for (const std::size_t k : voters_) result_.is_inlier[k] = 1;
    return std::move(result_);
  }
  VotedScales finished() {
    for (const std::size_t k : inliers_of(result_.winner)) result_.is_inlier[k] = 1;
    return std::move(result_);
  }

  Sessions sessions_;
  const ScaleVotingOptions& options_;
  std::vector<std::size_t> voters_;
  VotedScales result_;
};

/// The log scale that a session has by an inlier's, through the ratios between them; none where one is missing.
std::optional<double> carried(Sessions sessions, Ratios ratios, std::size_t from, std::size_t to) {
  double log_scale = std::log(sessions[from].scale);
  for (std::size_t k = std::min(from, to); k < std::max(from, to); ++k) {
    if (!ratios[k]) return std::nullopt;
    log_scale += (from < to ? 1.0 : -1.0) * log_ratio(ratios[k]);
  }
  return log_scale;
}

/// From the nearest inliers that ratios lead to.
std::optional<double> from_nearest_inliers(Sessions sessions, Ratios ratios, const VotedScales& vote, std::size_t k) {
  for (std::size_t distance = 1; distance < sessions.size(); ++distance) {
    std::vector<double> found;
    if (k >= distance && vote.is_inlier[k - distance]) {
      if (const auto value = carried(sessions, ratios, k - distance, k)) found.push_back(*value);
    }
    if (k + distance < sessions.size() && vote.is_inlier[k + distance]) {
      if (const auto value = carried(sessions, ratios, k + distance, k)) found.push_back(*value);
    }
    if (!found.empty()) return std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size());
  }
  return std::nullopt;
}

double median_log_scale(Sessions sessions, const VotedScales& vote) {
  std::vector<double> logs;
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    if (vote.is_inlier[k]) logs.push_back(std::log(sessions[k].scale));
  }
  return median(logs);
}

/// A session that no inlier reaches.
double left_alone(Sessions sessions, VotedScales& vote, std::size_t k) {
  if (sessions[k].is_usable) {
    vote.warnings.push_back(fmt::format("session {}: outvoted, and linked to no inlier: it keeps its own scale", k));
    return std::log(sessions[k].scale);
  }
  vote.warnings.push_back(
      fmt::format("session {}: no baseline, and linked to no usable session: the median scale is taken", k));
  return median_log_scale(sessions, vote);
}

void replace_outliers(Sessions sessions, Ratios ratios, VotedScales& vote) {
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    if (vote.is_inlier[k]) {
      vote.scales.push_back(sessions[k].scale);
      continue;
    }
    const auto log_scale = from_nearest_inliers(sessions, ratios, vote, k);
    vote.scales.push_back(std::exp(log_scale ? *log_scale : left_alone(sessions, vote, k)));
  }
}

/// Sessions begin ... end - 1, which ratios link, corrected at once.
std::vector<double> corrected_run(Sessions sessions, Ratios ratios, const VotedScales& vote,
                                  const ScaleVotingOptions& options, std::size_t begin, std::size_t end) {
  ScaleChain chain;
  chain.cauchy_width = options.cauchy_width;
  for (std::size_t k = begin; k < end; ++k) {
    const double sigma = std::max(sessions[k].sigma_log, options.least_sigma_log);
    chain.z.push_back(vote.is_inlier[k] ? std::log(sessions[k].scale) : 0.0);
    chain.a.push_back(vote.is_inlier[k] ? 1.0 / (sigma * sigma) : 0.0);
    if (k + 1 == end) break;
    chain.log_r.push_back(log_ratio(ratios[k]));
    const double least = options.least_sigma_log;
    chain.b.push_back(1.0 / (ratios[k]->sigma_log * ratios[k]->sigma_log + least * least));
  }
  return corrected_log_scales(chain);
}

void correct_together(Sessions sessions, Ratios ratios, const ScaleVotingOptions& options, VotedScales& vote) {
  vote.scales.resize(sessions.size());
  for (std::size_t begin = 0, end = 0; begin < sessions.size(); begin = end) {
    end = begin + 1;
    while (end < sessions.size() && ratios[end - 1]) ++end;
    const bool has_inlier =
        std::any_of(vote.is_inlier.begin() + static_cast<std::ptrdiff_t>(begin),
                    vote.is_inlier.begin() + static_cast<std::ptrdiff_t>(end), [](char c) { return c != 0; });
    std::vector<double> log_scales;
    if (has_inlier) log_scales = corrected_run(sessions, ratios, vote, options, begin, end);
    for (std::size_t k = begin; k < end; ++k) {
      vote.scales[k] = std::exp(has_inlier ? log_scales[k - begin] : left_alone(sessions, vote, k));
    }
  }
}

}  // namespace

VotedScales vote_scales(Sessions sessions, Ratios ratios, const ScaleVotingOptions& options) {
  check(sessions, ratios, options);
  Vote vote(sessions, options);
  if (options.mode == ScaleVoting::kPaper) {
    VotedScales result = vote.sampled();
    replace_outliers(sessions, ratios, result);
    return result;
  }
  VotedScales result = vote.exhaustive(ratios);
  correct_together(sessions, ratios, options, result);
  return result;
}

}  // namespace cmap
