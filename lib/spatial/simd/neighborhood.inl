// Moments of all neighbors within a radius, for sixteen queries at a time; plain loops over doubles that compilers
// vectorize, each lane adding its neighbors in the same order at every instruction set.

namespace cmap::CMAP_LANES {
namespace {

/// Sums over the neighbors of sixteen queries, relative to the query.
struct Moments16 {
  alignas(64) double n[16], x[16], y[16], z[16], xx[16], xy[16], xz[16], yy[16], yz[16], zz[16];
};

struct QueryLanes {
  alignas(64) double x[16], y[16], z[16];
};

inline void add_point(const QueryLanes& q, double px, double py, double pz, double sq_radius, Moments16& m) {
  for (int i = 0; i < 16; ++i) {
    const double dx = px - q.x[i];
    const double dy = py - q.y[i];
    const double dz = pz - q.z[i];
    const double inside = dx * dx + dy * dy + dz * dz <= sq_radius ? 1.0 : 0.0;
    const double wx = inside * dx;
    const double wy = inside * dy;
    const double wz = inside * dz;
    m.n[i] += inside;
    m.x[i] += wx;
    m.y[i] += wy;
    m.z[i] += wz;
    m.xx[i] += wx * dx;
    m.xy[i] += wx * dy;
    m.xz[i] += wx * dz;
    m.yy[i] += wy * dy;
    m.yz[i] += wy * dz;
    m.zz[i] += wz * dz;
  }
}

/// A determinant this small beside (trace / 3)^3 is the rounding noise of a flat neighborhood.
constexpr double kFlat = 1e-14;

struct Covariance {
  double xx, xy, xz, yy, yz, zz;
};

/// Of lane i's n neighbors; the query itself adds zeros to the sums.
inline Covariance covariance_of(const Moments16& m, int i, double n) {
  const double f = 1.0 / (n - 1.0);
  return {(m.xx[i] - m.x[i] * m.x[i] / n) * f, (m.xy[i] - m.x[i] * m.y[i] / n) * f,
          (m.xz[i] - m.x[i] * m.z[i] / n) * f, (m.yy[i] - m.y[i] * m.y[i] / n) * f,
          (m.yz[i] - m.y[i] * m.z[i] / n) * f, (m.zz[i] - m.z[i] * m.z[i] / n) * f};
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

class NeighborhoodGroup {
 public:
  NeighborhoodGroup(const Tree& tree, const PointBlock& block, double radius_m)
      : tree_(tree),
        sq_radius_(radius_m * radius_m),
        sq_reach_(static_cast<float>(sq_radius_ * (1.0 + kRounding))),
        moments_{} {
    q_ = {load(block.x), load(block.y), load(block.z)};
    for (int i = 0; i < 16; ++i) {
      lanes_.x[i] = block.x[i];
      lanes_.y[i] = block.y[i];
      lanes_.z[i] = block.z[i];
    }
  }

  const Moments16& collect() {
    walk(tree_, box_of(q_, mask_from_bits(kAllLanes)), *this);
    return moments_;
  }

  Mask16 children(int, std::uint32_t, const Float16& sq_dist) const {
    return less_equal(sq_dist, broadcast(sq_reach_));
  }
  bool matters(int level, std::uint32_t node, int c) const {
    return bits(less_equal(sq_dist_to_child(tree_.boxes[level][node], c, q_), broadcast(sq_reach_))) != 0;
  }
  void scan(std::uint32_t block) {
    const PointBlock& p = tree_.blocks[block];
    const int n = tree_.points_in(block);
    for (int k = 0; k < n; ++k) add_point(lanes_, p.x[k], p.y[k], p.z[k], sq_radius_, moments_);
  }

 private:
  const Tree& tree_;
  double sq_radius_;
  float sq_reach_;
  Lanes3 q_;
  QueryLanes lanes_;
  Moments16 moments_;
};

void neighborhood_shapes(const Bvh& cloud, double radius_m, double file_step_m, std::size_t begin, std::size_t end,
                         NeighborhoodShape& result) {
  const Tree tree(cloud);
  for (std::size_t block = begin; block < end; ++block) {
    NeighborhoodGroup group(tree, tree.blocks[block], radius_m);
    const Moments16& moments = group.collect();
    for (int i = 0; i < tree.points_in(block); ++i) {
      const std::size_t slot = block * kBlockSize + static_cast<std::size_t>(i);
      const double n = moments.n[i] - 1.0;  // without the query itself
      result.n_neighbors.data()[slot] = static_cast<std::uint32_t>(n);
      result.covariance_det.data()[slot] = __builtin_nan("");
      result.is_flat.data()[slot] = 0;
      if (n < 2.0) continue;
      const Covariance covariance = covariance_of(moments, i, n);
      const double det = covariance_det(covariance);
      result.covariance_det.data()[slot] = det;
      result.is_flat.data()[slot] =
          det == 0.0 || is_flat(covariance, step_around(tree.blocks[block], i, radius_m, file_step_m)) ? 1 : 0;
    }
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
