// Moments of all neighbors within a radius, for sixteen queries at a time; plain loops over doubles and integers that
// compilers vectorize. Terms are rounded to fixed steps and added as integers: the order of the neighbors, which is the
// tree's, changes no bit, and no instruction set does.

namespace cmap::CMAP_LANES {
namespace {

/// Terms below a power of two in two windows (pre-rounding after Demmel and Nguyen 2015, "Parallel Reproducible
/// Summation"): whole steps of 2^-32 of it, and of the rest whole steps of 2^-64. Sums of 2^31 terms fit 64 bits.
struct Windows {
  double high, low;  ///< 1.5 x 2^52 steps: what is added to them is rounded to whole steps, which end the double's bits
  double high_step, low_step;
};

inline Windows windows_below(int exponent) {
  const double high_step = __builtin_ldexp(1.0, exponent - 32), low_step = __builtin_ldexp(1.0, exponent - 64);
  return {0x1.8p52 * high_step, 0x1.8p52 * low_step, high_step, low_step};
}

inline std::uint64_t bits_of(double v) { return __builtin_bit_cast(std::uint64_t, v); }

/// Sums of one kind of terms for sixteen queries; each holds the bits of its window as often as a term was added.
struct Sums16 {
  alignas(64) std::uint64_t high[16], low[16];

  void add(int lane, double term, const Windows& window) {
    const double in_high = term + window.high;
    const double rest = term - (in_high - window.high);
    high[lane] += bits_of(in_high);
    low[lane] += bits_of(rest + window.low);
  }
  double value(int lane, std::uint64_t n_terms, const Windows& window) const {
    const auto steps = static_cast<std::int64_t>(high[lane] - n_terms * bits_of(window.high));
    const auto rest = static_cast<std::int64_t>(low[lane] - n_terms * bits_of(window.low));
    return static_cast<double>(steps) * window.high_step + static_cast<double>(rest) * window.low_step;
  }
};

inline double extent(const float* min, const float* max) {
  float low = min[0], high = max[0];
  for (int c = 1; c < 16; ++c) {
    low = min[c] < low ? min[c] : low;
    high = max[c] > high ? max[c] : high;
  }
  return static_cast<double>(high) - low;
}

/// Windows for the offsets of neighbors and for their products. A radius beyond the whole cloud is as good as that.
struct MomentWindows {
  MomentWindows(const BoxNode& root, double radius_m) {
    const double x = extent(root.min_x, root.max_x), y = extent(root.min_y, root.max_y);
    const double z = extent(root.min_z, root.max_z);
    const double widest = x > y ? (x > z ? x : z) : (y > z ? y : z);
    int exponent = 0;
    __builtin_frexp(radius_m < widest ? radius_m : widest, &exponent);
    constexpr int kLeast = -149;  // the smallest float is a multiple of 2^-149
    exponent = exponent < kLeast ? kLeast : exponent;
    offset = windows_below(exponent);
    product = windows_below(2 * exponent);
  }
  Windows offset, product;
};

/// Sums over the neighbors of sixteen queries, relative to the query.
struct Moments16 {
  alignas(64) double n[16];
  Sums16 x, y, z, xx, xy, xz, yy, yz, zz;
};

struct QueryLanes {
  alignas(64) double x[16], y[16], z[16];
};

inline void add_point(const QueryLanes& q, double px, double py, double pz, double sq_radius,
                      const MomentWindows& windows, Moments16& m) {
  const Windows offset = windows.offset, product = windows.product;
  for (int i = 0; i < 16; ++i) {
    const double dx = px - q.x[i];
    const double dy = py - q.y[i];
    const double dz = pz - q.z[i];
    const double inside = dx * dx + dy * dy + dz * dz <= sq_radius ? 1.0 : 0.0;
    const double wx = inside * dx;
    const double wy = inside * dy;
    const double wz = inside * dz;
    m.n[i] += inside;
    m.x.add(i, wx, offset);
    m.y.add(i, wy, offset);
    m.z.add(i, wz, offset);
    m.xx.add(i, wx * dx, product);
    m.xy.add(i, wx * dy, product);
    m.xz.add(i, wx * dz, product);
    m.yy.add(i, wy * dy, product);
    m.yz.add(i, wy * dz, product);
    m.zz.add(i, wz * dz, product);
  }
}

/// A determinant this small beside (trace / 3)^3 is the rounding noise of a flat neighborhood.
constexpr double kFlat = 1e-14;

struct Covariance {
  double xx, xy, xz, yy, yz, zz;
};

/// Of lane i's n neighbors; the query itself adds zeros to the sums.
inline Covariance covariance_of(const Moments16& m, int i, double n, std::uint64_t n_terms,
                                const MomentWindows& windows) {
  const auto of_offsets = [&](const Sums16& sums) { return sums.value(i, n_terms, windows.offset); };
  const auto of_products = [&](const Sums16& sums) { return sums.value(i, n_terms, windows.product); };
  const double x = of_offsets(m.x), y = of_offsets(m.y), z = of_offsets(m.z);
  const double f = 1.0 / (n - 1.0);
  return {(of_products(m.xx) - x * x / n) * f, (of_products(m.xy) - x * y / n) * f,
          (of_products(m.xz) - x * z / n) * f, (of_products(m.yy) - y * y / n) * f,
          (of_products(m.yz) - y * z / n) * f, (of_products(m.zz) - z * z / n) * f};
}

inline double determinant(const Covariance& c) {
  return c.xx * (c.yy * c.zz - c.yz * c.yz) - c.xy * (c.xy * c.zz - c.yz * c.xz) + c.xz * (c.xy * c.yz - c.yy * c.xz);
}

/// 0 where it is no more than rounding noise.
inline double covariance_det(const Covariance& c) {
  const double det = determinant(c);
  const double third_of_trace = (c.xx + c.yy + c.zz) / 3.0;
  return det > kFlat * third_of_trace * third_of_trace * third_of_trace ? det : 0.0;
}

/// Whether the smallest eigenvalue is below the square of a step: whether C - step^2 I is not positive definite, by its
/// leading minors (Sylvester).
inline bool is_flat(Covariance c, double step_m) {
  const double sq_step = step_m * step_m;
  c.xx -= sq_step;
  c.yy -= sq_step;
  c.zz -= sq_step;
  return !(c.xx > 0.0 && c.xx * c.yy - c.xy * c.xy > 0.0 && determinant(c) > 0.0);
}

/// The step of the coordinates within the radius of a point, m: those around the origin are no finer than their own.
inline double step_around(const PointBlock& p, int i, double radius_m, double file_step_m) {
  const float largest = larger(__builtin_fabsf(p.x[i]), larger(__builtin_fabsf(p.y[i]), __builtin_fabsf(p.z[i])));
  const double step_m = float_step(largest + static_cast<float>(radius_m));
  return step_m < file_step_m ? file_step_m : step_m;
}

/// Finite, as absent children of the tree are infinitely far.
inline float reach_of(double sq_radius) {
  const double sq_reach = sq_radius * (1.0 + kRounding);
  return sq_reach < __FLT_MAX__ ? static_cast<float>(sq_reach) : __FLT_MAX__;
}

class NeighborhoodGroup {
 public:
  NeighborhoodGroup(const Tree& tree, const PointBlock& block, double radius_m, const MomentWindows& windows)
      : tree_(tree), windows_(windows), sq_radius_(radius_m * radius_m), sq_reach_(reach_of(sq_radius_)), moments_{} {
    q_ = {load(block.x), load(block.y), load(block.z)};
    for (int i = 0; i < 16; ++i) {
      lanes_.x[i] = block.x[i];
      lanes_.y[i] = block.y[i];
      lanes_.z[i] = block.z[i];
    }
  }

  void collect() { walk(tree_, box_of(q_, mask_from_bits(kAllLanes)), *this); }

  /// Of lane i, without the query itself.
  double n_neighbors(int i) const { return moments_.n[i] - 1.0; }
  Covariance covariance(int i) const { return covariance_of(moments_, i, n_neighbors(i), n_terms_, windows_); }

  Mask16 children(int, std::uint32_t, const Float16& sq_dist) const {
    return less_equal(sq_dist, broadcast(sq_reach_));
  }
  bool matters(int level, std::uint32_t node, int c) const {
    return bits(less_equal(sq_dist_to_child(tree_.boxes[level][node], c, q_), broadcast(sq_reach_))) != 0;
  }
  void scan(std::uint32_t block) {
    const PointBlock& p = tree_.blocks[block];
    const int n = tree_.points_in(block);
    for (int k = 0; k < n; ++k) {
      if (bits(less_equal(sq_dist_to(q_, p.x[k], p.y[k], p.z[k]), broadcast(sq_reach_))) == 0) continue;
      add_point(lanes_, p.x[k], p.y[k], p.z[k], sq_radius_, windows_, moments_);
      ++n_terms_;
    }
  }

 private:
  const Tree& tree_;
  const MomentWindows& windows_;
  double sq_radius_;
  float sq_reach_;
  Lanes3 q_;
  QueryLanes lanes_;
  Moments16 moments_;
  std::uint64_t n_terms_ = 0;  ///< of every lane: those of points outside its radius are zeros
};

void neighborhood_shapes(const Bvh& cloud, double radius_m, double file_step_m, std::size_t begin, std::size_t end,
                         NeighborhoodShape& result) {
  const Tree tree(cloud);
  const MomentWindows windows(tree.boxes[tree.n_levels - 1][0], radius_m);
  for (std::size_t block = begin; block < end; ++block) {
    NeighborhoodGroup group(tree, tree.blocks[block], radius_m, windows);
    group.collect();
    for (int i = 0; i < tree.points_in(block); ++i) {
      const std::size_t slot = block * kBlockSize + static_cast<std::size_t>(i);
      const double n = group.n_neighbors(i);
      result.n_neighbors.data()[slot] = static_cast<std::uint32_t>(n);
      result.covariance_det.data()[slot] = __builtin_nan("");
      result.is_flat.data()[slot] = 0;
      if (n < 2.0) continue;
      const Covariance covariance = group.covariance(i);
      const double det = covariance_det(covariance);
      result.covariance_det.data()[slot] = det;
      result.is_flat.data()[slot] =
          det == 0.0 || is_flat(covariance, step_around(tree.blocks[block], i, radius_m, file_step_m)) ? 1 : 0;
    }
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
