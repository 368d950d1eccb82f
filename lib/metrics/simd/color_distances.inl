// Wasserstein distances of colors; the formulas are those of wasserstein.cpp.

namespace cmap::CMAP_LANES {
namespace {

constexpr std::size_t kLanes = ColorPairLanes::kLanes;
using Lanes = double[kLanes];

double square_root(double x) { return __builtin_sqrt(x); }
double largest(double a, double b) { return a > b ? a : b; }
double smallest(double a, double b) { return a < b ? a : b; }

/// A symmetric matrix.
struct Symmetric {
  double xx, xy, xz, yy, yz, zz;

  [[gnu::always_inline]] double dot(const Symmetric& o) const {
    return xx * o.xx + yy * o.yy + zz * o.zz + 2.0 * (xy * o.xy + xz * o.xz + yz * o.yz);
  }
  double trace() const { return xx + yy + zz; }
  [[gnu::always_inline]] Symmetric cofactors() const {
    return {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
            xx * zz - xz * xz, xz * xy - xx * yz, xx * yy - xy * xy};
  }
  /// Of a covariance, by its Schur complement about the largest variance: what is small keeps its digits.
  [[gnu::always_inline]] double determinant() const {
    const bool is_y = yy > xx && yy >= zz, is_z = !is_y && zz > xx;
    const double pivot = is_z ? zz : (is_y ? yy : xx), i = is_z || is_y ? xx : yy, k = is_z ? yy : zz;
    const double pi = is_z ? xz : xy, pk = is_z || is_y ? yz : xz, ik = is_z ? xy : (is_y ? xz : yz);
    const double by = 1.0 / largest(pivot, 1e-300);
    const double ii = largest(0.0, i - pi * pi * by), kk = largest(0.0, k - pk * pk * by), rest = ik - pi * pk * by;
    return largest(0.0, pivot * (ii * kk - rest * rest));
  }
};

/// Of whole numbers, whose products are exact: one rounding is all there is.
[[gnu::always_inline]] inline Symmetric covariance(const std::uint32_t (&words)[ColorPairLanes::kWords][kLanes],
                                                   std::size_t i) {
  const double n = words[0][i], r = words[1][i], g = words[2][i], b = words[3][i];
  const double by = 1.0 / (n * (n - 1.0));
  return {(n * words[4][i] - r * r) * by, (n * words[5][i] - r * g) * by, (n * words[6][i] - r * b) * by,
          (n * words[7][i] - g * g) * by, (n * words[8][i] - g * b) * by, (n * words[9][i] - b * b) * by};
}

/// The sum r of the roots of three eigenvalues, from their sums of products; r is sqrt(3 e1) first.
void sums_of_roots(const Lanes& e1, const Lanes& e2, const Lanes& root_e3, Lanes& r) {
  for (int step = 0; step < kFixedPointSteps; ++step) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      r[i] = square_root(e1[i] + 2.0 * square_root(e2[i] + 2.0 * root_e3[i] * r[i]));
    }
  }
  for (int step = 0; step < kNewtonSteps; ++step) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double q = square_root(e2[i] + 2.0 * root_e3[i] * r[i]);
      const double next = square_root(e1[i] + 2.0 * q), product = q * next;  // at least 9 root_e3
      r[i] += (next - r[i]) * product / largest(product - root_e3[i], 1e-300);
    }
  }
}

void color_distances(const ColorPairLanes& pairs, double* distances) {
  Lanes e1, e2, root_e3, traces, roots;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Symmetric a = covariance(pairs.reference, i), b = covariance(pairs.estimate, i);
    traces[i] = a.trace() + b.trace();
    e1[i] = largest(0.0, a.dot(b));
    e2[i] = largest(0.0, a.cofactors().dot(b.cofactors()));
    roots[i] = square_root(3.0 * e1[i]);
    const double product = square_root(a.determinant() * b.determinant());
    // 3 e1 e3 <= e2^2, which noise may not break.
    root_e3[i] = smallest(product, e2[i] / largest(roots[i], 1e-300));
  }
  sums_of_roots(e1, e2, root_e3, roots);
  for (std::size_t i = 0; i < kLanes; ++i) {
    double sq = traces[i] - 2.0 * roots[i];
    // Exact products: equal means are 0 apart.
    const double n_reference = pairs.reference[0][i], n_estimate = pairs.estimate[0][i];
    const double by = 1.0 / (n_reference * n_estimate);
    for (std::size_t channel = 1; channel <= 3; ++channel) {
      const double d = (pairs.reference[channel][i] * n_estimate - pairs.estimate[channel][i] * n_reference) * by;
      sq += d * d;
    }
    distances[i] = sq < 1e-12 * traces[i] || sq <= 0.0 ? 0.0 : square_root(sq);
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
