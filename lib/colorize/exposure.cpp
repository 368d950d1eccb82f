#include "cmap/colorize/exposure.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Logarithms of levels of the same points in several images.
struct SharedLevel {
  std::size_t image;
  double log_level;
  double weight = 1.0;
};
struct SharedLevels {
  std::vector<SharedLevel> levels;
  std::vector<std::size_t> starts{0};  ///< of points; one more at the end

  std::size_t n_points() const { return starts.size() - 1; }
  std::span<SharedLevel> of(std::size_t point) { return {&levels[starts[point]], starts[point + 1] - starts[point]}; }
};

/// The level that counts: a channel, or the mean of all (channel 3).
double level_of(const Rgb8& color, int channel) {
  if (channel < 3) return color[static_cast<std::size_t>(channel)];
  return (color[0] + color[1] + color[2]) / 3.0;
}

bool is_usable(const Rgb8& color, int channel, const ExposureOptions& o) {
  if (channel < 3) {
    const int level = color[static_cast<std::size_t>(channel)];
    return level >= o.darkest && level <= o.brightest;
  }
  return *std::ranges::max_element(color) <= o.brightest && level_of(color, channel) >= o.darkest;
}

SharedLevels shared_levels(const Observations& observations, std::size_t n_images, int channel,
                           const ExposureOptions& options) {
  const std::size_t wanted = std::max(options.most_points, options.points_per_image * n_images);
  const std::size_t step = std::max<std::size_t>(1, observations.n_points() / wanted);
  SharedLevels shared;
  for (std::size_t point = 0; point < observations.n_points(); point += step) {
    for (const Observation& seen : observations.of(point)) {
      if (!is_usable(seen.color, channel, options)) continue;
      shared.levels.push_back({seen.image, std::log(level_of(seen.color, channel))});
    }
    if (shared.levels.size() - shared.starts.back() < 2) {
      shared.levels.resize(shared.starts.back());
    } else {
      shared.starts.push_back(shared.levels.size());
    }
  }
  return shared;
}

/// The logarithm of a point's color, given gains.
double log_color(std::span<const SharedLevel> levels, const Eigen::VectorXd& log_gain) {
  double sum = 0.0, weights = 0.0;
  for (const SharedLevel& l : levels) {
    sum += l.weight * (l.log_level - log_gain[static_cast<Eigen::Index>(l.image)]);
    weights += l.weight;
  }
  return sum / weights;
}

/// Cauchy weights of the residuals; returns their sigma.
double reweight(SharedLevels& shared, const Eigen::VectorXd& log_gain, double least_sigma) {
  std::vector<double> residuals;
  residuals.reserve(shared.levels.size());
  for (std::size_t p = 0; p < shared.n_points(); ++p) {
    const double color = log_color(shared.of(p), log_gain);
    for (const SharedLevel& l : shared.of(p)) {
      residuals.push_back(l.log_level - log_gain[static_cast<Eigen::Index>(l.image)] - color);
    }
  }
  const double sigma = std::max(least_sigma, robust_sigma(residuals, 0.0));
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double r = residuals[i] / sigma;
    shared.levels[i].weight = 1.0 / (1.0 + r * r);
  }
  return sigma;
}

/// The normal equations without the points' colors: of a point with weights w of sum W, diag(w) - w w^T / W.
Eigen::VectorXd solve(SharedLevels& shared, double sigma, Eigen::Index n, const ExposureOptions& options) {
  Triplets triplets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const double precision = 1.0 / (sigma * sigma);
  for (std::size_t p = 0; p < shared.n_points(); ++p) {
    double sum = 0.0, weights = 0.0;
    for (const SharedLevel& l : shared.of(p)) {
      sum += l.weight * l.log_level;
      weights += l.weight;
    }
    for (const SharedLevel& a : shared.of(p)) {
      const auto row = static_cast<Eigen::Index>(a.image);
      right[row] += precision * a.weight * (a.log_level - sum / weights);
      triplets.emplace_back(row, row, precision * a.weight);
      for (const SharedLevel& b : shared.of(p)) {
        const auto column = static_cast<Eigen::Index>(b.image);
        if (column <= row) triplets.emplace_back(row, column, -precision * a.weight * b.weight / weights);
      }
    }
  }
  const double prior = 1.0 / (options.sigma_gain * options.sigma_gain);
  for (Eigen::Index i = 0; i < n; ++i) triplets.emplace_back(i, i, prior);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

/// Logarithms of gains, the median 0.
Eigen::VectorXd log_gains(const Observations& observations, std::size_t n_images, int channel,
                          const ExposureOptions& options) {
  SharedLevels shared = shared_levels(observations, n_images, channel, options);
  const auto n = static_cast<Eigen::Index>(n_images);
  Eigen::VectorXd log_gain = Eigen::VectorXd::Zero(n);
  if (shared.n_points() == 0) return log_gain;
  for (int pass = 0; pass < options.passes; ++pass) {
    throw_if_stopped();
    const double sigma = reweight(shared, log_gain, options.least_sigma);
    log_gain = solve(shared, sigma, n, options);
  }
  std::vector<double> sorted(log_gain.begin(), log_gain.end());
  return log_gain.array() - upper_median(sorted);
}

}  // namespace

Eigen::Matrix3Xd exposure_gains_of(const Observations& observations, std::size_t n_images,
                                   const ExposureOptions& options) {
  Eigen::Matrix3Xd gains = Eigen::Matrix3Xd::Ones(3, static_cast<Eigen::Index>(n_images));
  if (options.model == ExposureModel::kNone || n_images < 2) return gains;
  for (int channel = 0; channel < 3; ++channel) {
    if (options.model == ExposureModel::kGain && channel > 0) {
      gains.row(channel) = gains.row(0);
    } else {
      const int of = options.model == ExposureModel::kGain ? 3 : channel;
      gains.row(channel) = log_gains(observations, n_images, of, options).array().exp().transpose();
    }
  }
  return gains;
}

}  // namespace cmap
