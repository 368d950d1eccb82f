#pragma once

#include <Eigen/Core>
#include <string>

#include "cmap/align/alignment.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// Normal equations of one step x -> exp(scale) exp(rotation) (x - pivot) + pivot + translation. Parameters in order:
/// rotation (rad), translation (m), log scale.
struct NormalEquations {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  std::size_t n = 0;
  NormalEquations& operator+=(const NormalEquations& other) {
    H += other.H;
    g += other.g;
    n += other.n;
    return *this;
  }
  /// Adds weight (r . normal)^2, r the residual of a moved point `arm` away from the pivot.
  void add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& r, const Eigen::Vector3d& normal, double weight);
  /// Adds weight r^T M r.
  void add(const Eigen::Vector3d& arm, const Eigen::Vector3d& r, const Eigen::Matrix3d& M, double weight);
};

/// The Gauss-Newton step's parameters, the log scale 0 where it is not asked for. Directions that the equations do not
/// determine stay; lever_m makes rotation, scale and translation comparable.
Vector7d solve_parameters(const NormalEquations& equations, bool with_scale, double lever_m);

/// That step as a transform about the pivot.
Similarity solve_step(const NormalEquations& equations, bool with_scale, double lever_m, const Eigen::Vector3d& pivot);

/// Condition and weakest direction of an information matrix; see Alignment.
struct Observability {
  double condition = 0.0;
  std::string weakest;
};
Observability observability(const Matrix7d& H, bool with_scale, double lever_m);

/// Standard errors along the axes of the translation's and the rotation's uncertainty, and of the scale where it is
/// estimated, the worst first: from the information matrix H of a sum of squares and the variance of its gradient.
/// Directions without information are infinitely uncertain. A rotation's and the scale's are what they move a point
/// `far_m` away by.
std::vector<WeakDirection> standard_errors(const Matrix7d& H, const Matrix7d& gradient, bool with_scale, double lever_m,
                                           double far_m);

/// Into the result, with a warning where a direction is only weakly determined.
void tell_observability(const Observability& found, Alignment& result);

/// A warning where the iterations did not settle.
void tell_convergence(Alignment& result);

}  // namespace cmap
