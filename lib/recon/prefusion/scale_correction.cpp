#include "prefusion/scale_correction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

/// The x that solves the weighted system: Thomas' algorithm on a symmetric positive definite tridiagonal matrix.
std::vector<double> least_squares(const ScaleChain& chain, std::span<const double> weights) {
  const std::size_t n = chain.z.size();
  std::vector<double> diagonal(n), right(n);
  for (std::size_t k = 0; k < n; ++k) {
    diagonal[k] = weights[k];
    right[k] = weights[k] * chain.z[k];
  }
  for (std::size_t k = 0; k + 1 < n; ++k) {
    diagonal[k] += chain.b[k];
    diagonal[k + 1] += chain.b[k];
    right[k] -= chain.b[k] * chain.log_r[k];
    right[k + 1] += chain.b[k] * chain.log_r[k];
  }
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double factor = chain.b[k] / diagonal[k];
    diagonal[k + 1] -= factor * chain.b[k];
    right[k + 1] += factor * right[k];
  }
  std::vector<double> x(n);
  for (std::size_t k = n; k-- > 0;) x[k] = (right[k] + (k + 1 < n ? chain.b[k] * x[k + 1] : 0.0)) / diagonal[k];
  return x;
}

std::vector<double> reweighted(const ScaleChain& chain, std::vector<double> x) {
  constexpr int kMaxPasses = 200;
  constexpr double kConverged = 1e-13;
  const double sq_width = chain.cauchy_width * chain.cauchy_width;
  std::vector<double> weights(x.size());
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double off = x[k] - chain.z[k];
      weights[k] = chain.a[k] / (1.0 + chain.a[k] * off * off / sq_width);
    }
    const std::vector<double> next = least_squares(chain, weights);
    double step = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) step = std::max(step, std::abs(next[k] - x[k]));
    x = next;
    if (step < kConverged) break;
  }
  return x;
}

/// All scales from one measurement, through the ratios.
std::vector<double> from_one(const ScaleChain& chain, std::size_t start) {
  std::vector<double> x(chain.z.size());
  x[start] = chain.z[start];
  for (std::size_t k = start; k + 1 < x.size(); ++k) x[k + 1] = x[k] + chain.log_r[k];
  for (std::size_t k = start; k-- > 0;) x[k] = x[k + 1] - chain.log_r[k];
  return x;
}

}  // namespace

double chain_cost(const ScaleChain& chain, std::span<const double> x) {
  const double sq_width = chain.cauchy_width * chain.cauchy_width;
  double cost = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double off = x[k] - chain.z[k];
    cost += sq_width * std::log1p(chain.a[k] * off * off / sq_width);
  }
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double off = x[k + 1] - x[k] - chain.log_r[k];
    cost += chain.b[k] * off * off;
  }
  return cost;
}

std::vector<double> corrected_log_scales(const ScaleChain& chain) {
  std::vector<double> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t start = 0; start < chain.z.size(); ++start) {
    if (!(chain.a[start] > 0.0)) continue;
    std::vector<double> x = reweighted(chain, from_one(chain, start));
    const double cost = chain_cost(chain, x);
    if (cost < lowest) {
      lowest = cost;
      best = std::move(x);
    }
  }
  return best;
}

}  // namespace cmap
