#include "cmap/align/umeyama.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "direction_text.hpp"

namespace cmap {
namespace {

/// Below this ratio of standard deviations a direction of the points is rounding noise of float coordinates.
constexpr double kFlat = 1e-6;

/// Points on one line or in one place: their rotation is not determined.
void require_spread(const PairMoments& moments) {
  if (moments.n < 3) {
    throw UnsupportedError(fmt::format("{} pairs of points do not determine a rotation; 3 are needed", moments.n));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments.scatter_p);
  const Eigen::Vector3d spread_m = (eigen.eigenvalues() / moments.weight).cwiseMax(0.0).cwiseSqrt();
  // Coordinates are accurate to their own rounding at best.
  const double noise_m = 1e-12 * moments.mean_p.norm();
  if (!(spread_m[2] > noise_m) || !(moments.sq_q > 0.0)) {
    throw UnsupportedError("all points of the pairs coincide: neither rotation nor scale is determined");
  }
  if (!(spread_m[1] > std::max(kFlat * spread_m[2], noise_m))) {
    throw UnsupportedError(fmt::format("the points of the pairs are collinear: the rotation about {} is not determined",
                                       direction_text(eigen.eigenvectors().col(2))));
  }
}

}  // namespace

namespace detail {

PairSums& PairSums::operator+=(const PairSums& other) {
  n += other.n;
  weight += other.weight;
  p += other.p;
  q += other.q;
  return *this;
}

CenteredSums& CenteredSums::operator+=(const CenteredSums& other) {
  cross += other.cross;
  scatter_p += other.scatter_p;
  sq_q += other.sq_q;
  return *this;
}

}  // namespace detail

Similarity fit_similarity(const PairMoments& moments, const ScaleModel& model) {
  require_spread(moments);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d singular = svd.singularValues();
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0) signs.z() = -1.0;
  // Two singular values that cancel or vanish leave a rotation about the first direction free.
  if (!(singular[1] + signs.z() * singular[2] > kFlat * kFlat * singular[0])) {
    throw UnsupportedError(
        fmt::format("the pairs do not determine the rotation about {}", direction_text(svd.matrixU().col(0))));
  }
  Similarity T;
  T.rotation = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  T.scale = model.s0;
  if (model.is_free) {
    const double agreement = singular.dot(signs);
    T.scale = (agreement + model.lambda_m2 * model.s0) / (moments.scatter_p.trace() + model.lambda_m2);
  }
  T.translation = moments.mean_q - T.scale * (T.rotation * moments.mean_p);
  return T;
}

double similarity_cost(const PairMoments& moments, const ScaleModel& model, const Similarity& T) {
  const Eigen::Vector3d offset = moments.mean_q - T * moments.mean_p;
  const double agreement = (T.rotation * moments.cross).trace();
  const double scale_error = T.scale - model.s0;
  return moments.sq_q - 2.0 * T.scale * agreement + T.scale * T.scale * moments.scatter_p.trace() +
         moments.weight * offset.squaredNorm() + model.lambda_m2 * scale_error * scale_error;
}

double best_agreement(const Eigen::Matrix3d& cross, Handedness handedness) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d singular = svd.singularValues();
  const bool reflects = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0;
  return singular[0] + singular[1] + (reflects == (handedness == Handedness::kMirrored) ? 1.0 : -1.0) * singular[2];
}

double reflection_cost(const PairMoments& moments, bool scale_is_free) {
  const double agreement = best_agreement(moments.cross, Handedness::kMirrored);
  const double spread = moments.scatter_p.trace();
  const double scale = scale_is_free && spread > 0.0 ? agreement / spread : 1.0;
  return std::max(0.0, moments.sq_q - 2.0 * scale * agreement + scale * scale * spread);
}

Similarity umeyama(std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3d> q, const ScaleModel& model,
                   std::span<const double> weights) {
  if (p.size() != q.size() || (!weights.empty() && weights.size() != p.size())) {
    throw std::invalid_argument("umeyama: points and weights must be equally many");
  }
  for (const double w : weights) {
    if (!(w >= 0.0) || !std::isfinite(w))
      throw std::invalid_argument("umeyama: weights must be finite and not negative");
  }
  const auto pair_at = [&](std::size_t i) { return WeightedPair{p[i], q[i], weights.empty() ? 1.0 : weights[i]}; };
  return fit_similarity(pair_moments(p.size(), pair_at), model);
}

}  // namespace cmap
