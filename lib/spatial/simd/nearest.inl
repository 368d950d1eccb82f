// Nearest neighbors of sixteen queries at a time.

namespace cmap::CMAP_LANES {
namespace {

constexpr std::uint32_t kAllLanes = 0xffff;
constexpr std::uint32_t kUnknownIndex = ~0u;

/// The search of one group: the best squared distance of every lane and the block that has it. The index is found at
/// the end, or earlier for lanes with ties.
class NearestGroup {
 public:
  NearestGroup(const Tree& tree, const Lanes3& queries) : tree_(tree), q_(queries), box_(box_of(queries, mask_from_bits(kAllLanes))) {
    for (int lane = 0; lane < 16; ++lane) {
      block_[lane] = 0;
      index_[lane] = kUnknownIndex;
    }
  }

  /// Scans blocks that probably hold the answer, so that the walk starts with a tight bound.
  void start_from(const std::uint32_t* guesses, int n) {
    for (n_scanned_ = 0; n_scanned_ < n; ++n_scanned_) {
      scanned_[n_scanned_] = guesses[n_scanned_];
      scan(guesses[n_scanned_]);
    }
  }

  void search() { walk(tree_, box_, *this); }

  Mask16 children(int level, std::uint32_t node, const Float16& sq_dist) const {
    const Mask16 near = less_equal(sq_dist, broadcast(bound_));
    const std::uint32_t tied = bits(near & equal(sq_dist, broadcast(bound_)));
    if (tied == 0 || bound_index_ == kUnknownIndex) return near;
    // Equally near children matter only if a lower original index is below them.
    std::uint32_t enter = bits(near);
    for (std::uint32_t rest = tied; rest != 0; rest &= rest - 1) {
      const int c = first_bit(rest);
      if (tree_.lowest_index[level][node].child[c] >= bound_index_) enter &= ~(1u << c);
    }
    return mask_from_bits(enter);
  }

  bool still(float sq_dist) const { return sq_dist <= bound_; }

  void block(const BoxNode& node, int c, std::uint32_t block) {
    for (int i = 0; i < n_scanned_; ++i) {
      if (scanned_[i] == block) return;
    }
    if (bits(less_equal(sq_dist_to_child(node, c, q_), best_)) != 0) scan(block);
  }

  /// Slot of every lane's nearest point.
  std::uint32_t slot(int lane) const {
    alignas(64) float best[16];
    store(best, best_);
    return slot_in_block(lane, block_[lane], best[lane]);
  }
  std::uint32_t block_of(int lane) const { return block_[lane]; }

 private:
  void scan(std::uint32_t block) {
    const PointBlock& points = tree_.blocks[block];
    Float16 nearest = broadcast(kInfinity);
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      nearest = min(sq_dist_to(q_, points.x[k], points.y[k], points.z[k]), nearest);
    }
    const std::uint32_t tied = bits(equal(nearest, best_));
    if (tied != 0) settle_ties(tied, block);
    const std::uint32_t nearer = bits(less(nearest, best_));
    if (nearer != 0) {
      best_ = min(nearest, best_);
      for (std::uint32_t rest = nearer; rest != 0; rest &= rest - 1) {
        block_[first_bit(rest)] = block;
        index_[first_bit(rest)] = kUnknownIndex;
      }
      bound_ = highest(best_);
    }
    if ((nearer | tied) != 0) update_bound_index();
  }

  /// Lanes whose best distance also occurs in `block`: the lowest original index wins.
  void settle_ties(std::uint32_t tied, std::uint32_t block) {
    alignas(64) float best[16];
    store(best, best_);
    for (; tied != 0; tied &= tied - 1) {
      const int lane = first_bit(tied);
      if (best[lane] == kInfinity) continue;
      if (index_[lane] == kUnknownIndex) {
        index_[lane] = tree_.original_index[slot_in_block(lane, block_[lane], best[lane])];
      }
      const std::uint32_t other = tree_.original_index[slot_in_block(lane, block, best[lane])];
      if (other < index_[lane]) {
        index_[lane] = other;
        block_[lane] = block;
      }
    }
    any_index_known_ = true;
  }

  void update_bound_index() {
    bound_index_ = kUnknownIndex;
    if (!any_index_known_) return;
    std::uint32_t highest_index = 0;
    for (int lane = 0; lane < 16; ++lane) highest_index = index_[lane] > highest_index ? index_[lane] : highest_index;
    bound_index_ = highest_index;
  }

  /// The slot in `block` at exactly the lane's best distance; of several, the one of the lowest original index.
  std::uint32_t slot_in_block(int lane, std::uint32_t block, float best) const {
    alignas(64) float x[16], y[16], z[16];
    store(x, q_.x);
    store(y, q_.y);
    store(z, q_.z);
    const PointBlock& points = tree_.blocks[block];
    const Lanes3 p{load(points.x), load(points.y), load(points.z)};
    std::uint32_t at_best = bits(equal(sq_dist_to(p, x[lane], y[lane], z[lane]), broadcast(best)));
    std::uint32_t slot = block * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(first_bit(at_best));
    for (at_best &= at_best - 1; at_best != 0; at_best &= at_best - 1) {
      const std::uint32_t other = block * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(first_bit(at_best));
      if (tree_.original_index[other] < tree_.original_index[slot]) slot = other;
    }
    return slot;
  }

  const Tree& tree_;
  const Lanes3 q_;
  const LaneBox box_;
  Float16 best_ = broadcast(kInfinity);
  float bound_ = __FLT_MAX__;  // an absent child is at infinity, never within the bound
  std::uint32_t bound_index_ = kUnknownIndex;
  bool any_index_known_ = false;
  std::uint32_t block_[16];
  std::uint32_t index_[16];
  std::uint32_t scanned_[4];
  int n_scanned_ = 0;
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
  for (std::size_t lane = 0; lane < kBlockSize && lane < n; ++lane) {
    const std::uint32_t slot = group.slot(static_cast<int>(lane));
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
    const Lanes3 q = load_queries(queries.points.blocks.data()[block], queries.shift);
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
