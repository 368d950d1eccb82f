// Nearest neighbors of sixteen queries at a time.

namespace cmap::CMAP_LANES {
namespace {

constexpr std::uint32_t kAllLanes = 0xffff;
constexpr std::uint32_t kNoBlock = ~0u;

/// Float squared distances up to this factor above the best are compared with it in double.
constexpr float kReach = static_cast<float>(1.0 + kRounding);

/// A candidate as it is compared in the end: in double, ties by original index.
struct Candidate {
  double sq_dist;
  std::uint32_t index;
  std::uint32_t slot;
};

inline bool comes_before(const Candidate& a, const Candidate& b) {
  return a.sq_dist < b.sq_dist || (a.sq_dist == b.sq_dist && a.index < b.index);
}

inline double gap_in_double(double v, double low, double high) { return v < low ? low - v : v > high ? v - high : 0.0; }

/// The search of one group: every lane's best squared distance in float and the block that has it. Candidates within
/// rounding of each other are told apart in double, in `exact_`; otherwise the point in the block is found at the end.
class NearestGroup {
 public:
  NearestGroup(const Tree& tree, const Lanes3& queries)
      : tree_(tree), q_(queries), box_(box_of(queries, mask_from_bits(kAllLanes))) {
    store(x_, q_.x);
    store(y_, q_.y);
    store(z_, q_.z);
  }

  /// Scans blocks that probably hold the answer, so that the walk starts with a tight bound. At least one: an absent
  /// child of a node is at infinity, which no finite bound reaches.
  void start_from(const std::uint32_t* guesses, int n) {
    for (int i = 0; i < n; ++i) {
      scanned_[i] = guesses[i];
      compare_with(guesses[i]);
    }
  }

  void search() { walk(tree_, box_, *this); }

  Mask16 children(int level, std::uint32_t node, const Float16& sq_dist) {
    const float bound = highest(best_);
    std::uint32_t enter = bits(less_equal(sq_dist, broadcast(bound * kReach)));
    if (known_ == 0) return mask_from_bits(enter);
    for (std::uint32_t tied = enter & ~bits(less(sq_dist, broadcast(bound))); tied != 0; tied &= tied - 1) {
      const int c = first_bit(tied);
      if (!can_settle(level, node, c, kAllLanes)) enter &= ~(1u << c);
    }
    return mask_from_bits(enter);
  }

  bool matters(int level, std::uint32_t node, int c) const {
    const Float16 sq_dist = sq_dist_to_child(tree_.boxes[level][node], c, q_);
    const std::uint32_t within = bits(less_equal(sq_dist, best_ * broadcast(kReach)));
    if (within == 0 || known_ == 0 || bits(less(sq_dist, best_)) != 0) return within != 0;
    return can_settle(level, node, c, within);
  }

  void scan(std::uint32_t block) {
    const bool is_scanned =
        (block == scanned_[0]) | (block == scanned_[1]) | (block == scanned_[2]) | (block == scanned_[3]);
    if (!is_scanned) compare_with(block);
  }

  /// Where the nearest point of every lane is.
  void finish(std::uint32_t* slots) const {
    alignas(64) float best[16];
    alignas(64) float blocks[16];
    store(best, best_);
    store(blocks, block_);
    for (int lane = 0; lane < 16; ++lane) {
      const auto block = __builtin_bit_cast(std::uint32_t, blocks[lane]);
      slots[lane] = is_known(lane) ? exact_[lane].slot : slot_in_block(lane, block, best[lane]);
    }
  }

  std::uint32_t block_of(int lane) const {
    alignas(64) float blocks[16];
    store(blocks, block_);
    return __builtin_bit_cast(std::uint32_t, blocks[lane]);
  }

 private:
  void compare_with(std::uint32_t block) {
    const PointBlock& points = tree_.blocks[block];
    Float16 nearest = broadcast(kInfinity);
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      nearest = min(sq_dist_to(q_, points.x[k], points.y[k], points.z[k]), nearest);
    }
    const Mask16 nearer = less(nearest * broadcast(kReach), best_);
    const std::uint32_t unsettled = bits(less_equal(nearest, best_ * broadcast(kReach))) & ~bits(nearer);
    if (unsettled != 0) settle(unsettled, block, min(nearest, best_));
    // Block numbers travel as the bits of floats: lanes are only selected, never computed with.
    block_ = select(nearer, broadcast(__builtin_bit_cast(float, block)), block_);
    known_ &= ~bits(nearer);
    best_ = min(nearest, best_);
  }

  bool is_known(int lane) const { return (known_ >> lane & 1u) != 0; }

  /// Lanes whose best so far and best in `block` are too close for float.
  void settle(std::uint32_t lanes, std::uint32_t block, const Float16& lowest_sq_dist) {
    alignas(64) float best[16];
    store(best, lowest_sq_dist);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_bit(lanes);
      const Candidate first = is_known(lane) ? exact_[lane] : exact_in_block(lane, block_of(lane), best[lane]);
      const Candidate second = exact_in_block(lane, block, best[lane]);
      exact_[lane] = comes_before(second, first) ? second : first;
      known_ |= 1u << lane;
    }
  }

  /// Whether a child no nearer than the best so far may still win one of the lanes in double or by its index. Without
  /// this, many copies of one point would all be visited.
  bool can_settle(int level, std::uint32_t node, int c, std::uint32_t lanes) const {
    alignas(64) float best[16];
    store(best, best_);
    const BoxNode& boxes = tree_.boxes[level][node];
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_bit(lanes);
      const double dx = gap_in_double(x_[lane], boxes.min_x[c], boxes.max_x[c]);
      const double dy = gap_in_double(y_[lane], boxes.min_y[c], boxes.max_y[c]);
      const double dz = gap_in_double(z_[lane], boxes.min_z[c], boxes.max_z[c]);
      const double sq_dist = dx * dx + dy * dy + dz * dz;
      const bool may_win = is_known(lane)
                               ? comes_before({sq_dist, tree_.lowest_index[level][node].child[c], 0}, exact_[lane])
                               : sq_dist <= static_cast<double>(best[lane] * kReach);
      if (may_win) return true;
    }
    return false;
  }

  /// Points of a block within reach of the lane's float squared distance `best`, a bit each.
  std::uint32_t within_reach(int lane, const PointBlock& p, float best) const {
    const Float16 sq_dist = sq_dist_to({load(p.x), load(p.y), load(p.z)}, x_[lane], y_[lane], z_[lane]);
    return bits(less_equal(sq_dist, broadcast(best * kReach)));
  }

  /// The lane's nearest point of a block in double, among those within reach of `best`.
  Candidate exact_in_block(int lane, std::uint32_t block, float best) const {
    const PointBlock& p = tree_.blocks[block];
    Candidate nearest{static_cast<double>(kInfinity), ~0u, 0};
    for (std::uint32_t within = within_reach(lane, p, best); within != 0; within &= within - 1) {
      const auto k = static_cast<std::uint32_t>(first_bit(within));
      const double dx = static_cast<double>(x_[lane]) - static_cast<double>(p.x[k]);
      const double dy = static_cast<double>(y_[lane]) - static_cast<double>(p.y[k]);
      const double dz = static_cast<double>(z_[lane]) - static_cast<double>(p.z[k]);
      const std::uint32_t slot = block * static_cast<std::uint32_t>(kBlockSize) + k;
      const Candidate candidate{dx * dx + dy * dy + dz * dz, tree_.original_index[slot], slot};
      if (comes_before(candidate, nearest)) nearest = candidate;
    }
    return nearest;
  }

  /// The same, where mostly a single point is within reach.
  std::uint32_t slot_in_block(int lane, std::uint32_t block, float best) const {
    const std::uint32_t within = within_reach(lane, tree_.blocks[block], best);
    if ((within & (within - 1)) != 0) return exact_in_block(lane, block, best).slot;
    return block * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(first_bit(within));
  }

  const Tree& tree_;
  const Lanes3 q_;
  const LaneBox box_;
  Float16 best_ = broadcast(kInfinity);
  Float16 block_ = broadcast(0.0f);
  std::uint32_t known_ = 0;  ///< lanes whose nearest point is in exact_
  alignas(64) float x_[16], y_[16], z_[16];
  Candidate exact_[16];
  std::uint32_t scanned_[4] = {kNoBlock, kNoBlock, kNoBlock, kNoBlock};
};

/// Distinct blocks that hold the neighbors of some lanes: the next group starts from them.
inline int distinct_blocks(const NearestGroup& group, std::uint32_t* guesses) {
  int n = 0;
  for (int lane = 0; lane < 16; lane += 5) {
    const std::uint32_t block = group.block_of(lane);
    bool known = false;
    for (int i = 0; i < n; ++i) known |= guesses[i] == block;
    if (!known) guesses[n++] = block;
  }
  return n;
}

/// The block reached by always taking the nearest child.
inline std::uint32_t nearest_block_greedily(const Tree& tree, const Lanes3& q) {
  const LaneBox box = box_of(q, mask_from_bits(kAllLanes));
  std::uint32_t node = 0;
  for (int level = tree.n_levels - 1; level >= 0; --level) {
    const Float16 sq_dist = sq_dist_to_children(tree.boxes[level][node], box);
    const std::uint32_t nearest_children = bits(equal(sq_dist, broadcast(lowest(sq_dist))));
    node = node * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(first_bit(nearest_children));
  }
  return node;
}

inline void write_results(const Tree& tree, const Queries& queries, const NearestGroup& group, std::size_t block,
                          NearestField& result) {
  const PointBlock& q = queries.points.blocks.data()[block];
  const double* shift = queries.shift.data();
  const std::size_t n = queries.points.size - block * kBlockSize;
  std::uint32_t nearest[16];
  group.finish(nearest);
  for (std::size_t lane = 0; lane < kBlockSize && lane < n; ++lane) {
    const std::uint32_t slot = nearest[lane];
    const PointBlock& p = tree.blocks[slot / kBlockSize];
    const std::size_t k = slot % kBlockSize;
    const double dx = (static_cast<double>(q.x[lane]) - static_cast<double>(p.x[k])) + shift[0];
    const double dy = (static_cast<double>(q.y[lane]) - static_cast<double>(p.y[k])) + shift[1];
    const double dz = (static_cast<double>(q.z[lane]) - static_cast<double>(p.z[k])) + shift[2];
    result.slot.data()[block * kBlockSize + lane] = slot;
    result.sq_dist.data()[block * kBlockSize + lane] = dx * dx + dy * dy + dz * dz;
  }
}

void nearest(const Bvh& index, const Queries& queries, std::size_t begin, std::size_t end, NearestField& result) {
  const Tree tree(index);
  std::uint32_t guesses[4];
  int n_guesses = 0;
  for (std::size_t block = begin; block < end; ++block) {
    const Lanes3 q = load_queries(queries.points.blocks.data()[block], queries.shift.data());
    if (n_guesses == 0) guesses[n_guesses++] = nearest_block_greedily(tree, q);
    NearestGroup group(tree, q);
    group.start_from(guesses, n_guesses);
    group.search();
    write_results(tree, queries, group, block, result);
    n_guesses = distinct_blocks(group, guesses);
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
