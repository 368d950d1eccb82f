#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cmap/recon/overlap_scale.hpp"

namespace cmap {

/// Log scales of sessions in a row, each linked to the next: z_k as measured with the weight a_k, 0 for none.
struct ScaleChain {
  std::vector<double> z, a;
  std::vector<double> log_r, b;  ///< one fewer
  double cauchy_width = 2.0;
};

/// sum c^2 log(1 + a_k (x_k - z_k)^2 / c^2) + sum b_k (x_{k+1} - x_k - log r_k)^2.
double chain_cost(const ScaleChain& chain, std::span<const double> x);

/// The x of least cost that reweighted least squares reach, starting from every measurement in turn. At least one a_k
/// must be positive, all b_k.
std::vector<double> corrected_log_scales(const ScaleChain& chain);

}  // namespace cmap
