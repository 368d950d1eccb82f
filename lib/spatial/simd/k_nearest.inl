// The k nearest points of one query at a time, compared with sixteen boxes or points at once.

namespace cmap::CMAP_LANES {
namespace {

constexpr std::size_t kMostNeighbors = 64;

/// The k best candidates so far, sorted; float decides only what is looked at, double what is nearer.
class NearestList {
 public:
  explicit NearestList(std::size_t k) : k_(k) {}

  void restart() {
    n_ = 0;
    reach_ = kInfinity;
  }
  /// Float squared distances above this cannot belong to the list.
  float reach() const { return reach_; }
  std::size_t size() const { return n_; }
  const Candidate& operator[](std::size_t i) const { return list_[i]; }

  void offer(const Candidate& candidate) {
    if (n_ == k_ && !comes_before(candidate, list_[n_ - 1])) return;
    std::size_t place = n_ < k_ ? n_++ : n_ - 1;
    for (; place > 0 && comes_before(candidate, list_[place - 1]); --place) list_[place] = list_[place - 1];
    list_[place] = candidate;
    // 1e-37: squared distances that underflow in float must not be cut off.
    if (n_ == k_) reach_ = static_cast<float>(list_[n_ - 1].sq_dist * (1.0 + 2.0 * kRounding) + 1e-37);
  }

 private:
  std::size_t k_;
  std::size_t n_ = 0;
  float reach_ = kInfinity;
  Candidate list_[kMostNeighbors];
};

inline void offer_block(const Tree& tree, std::uint32_t block, const float (&q)[3], NearestList& nearest) {
  const PointBlock& p = tree.blocks[block];
  const Float16 sq_dist = sq_dist_to({load(p.x), load(p.y), load(p.z)}, q[0], q[1], q[2]);
  const std::uint32_t present = (1u << tree.points_in(block)) - 1u;
  std::uint32_t near = bits(less_equal(sq_dist, broadcast(nearest.reach()))) & present;
  for (; near != 0; near &= near - 1) {
    const auto k = static_cast<std::uint32_t>(first_bit(near));
    const double dx = static_cast<double>(q[0]) - static_cast<double>(p.x[k]);
    const double dy = static_cast<double>(q[1]) - static_cast<double>(p.y[k]);
    const double dz = static_cast<double>(q[2]) - static_cast<double>(p.z[k]);
    const std::uint32_t slot = block * static_cast<std::uint32_t>(kBlockSize) + k;
    nearest.offer({dx * dx + dy * dy + dz * dz, tree.original_index[slot], slot});
  }
}

/// Children are entered nearest first, so that the reach shrinks early.
inline void descend(const Tree& tree, int level, std::uint32_t node, const float (&q)[3], const LaneBox& box,
                    std::uint32_t seen_block, NearestList& nearest) {
  const Float16 sq_dist = sq_dist_to_children(tree.boxes[level][node], box);
  alignas(64) float distances[16];
  store(distances, sq_dist);
  std::uint32_t left = bits(less(sq_dist, broadcast(kInfinity)));
  while (left != 0) {
    int c = first_bit(left);
    for (std::uint32_t others = left & (left - 1); others != 0; others &= others - 1) {
      const int other = first_bit(others);
      if (distances[other] < distances[c]) c = other;
    }
    if (!(distances[c] <= nearest.reach())) return;
    left &= ~(1u << c);
    const std::uint32_t child = node * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(c);
    if (level > 0) {
      descend(tree, level - 1, child, q, box, seen_block, nearest);
    } else if (child != seen_block) {
      offer_block(tree, child, q, nearest);
    }
  }
}

void k_nearest(const Bvh& index, const Queries& queries, std::size_t k, std::size_t begin, std::size_t end,
               std::uint32_t* slots) {
  const Tree tree(index);
  NearestList nearest(k);
  std::uint32_t guess = kNoBlock;
  for (std::size_t slot = begin * kBlockSize; slot < end * kBlockSize && slot < queries.points.size; ++slot) {
    const PointBlock& block = queries.points.blocks.data()[slot / kBlockSize];
    const std::size_t lane = slot % kBlockSize;
    const double* shift = queries.shift.data();
    const float q[3] = {block.x[lane] + static_cast<float>(shift[0]), block.y[lane] + static_cast<float>(shift[1]),
                        block.z[lane] + static_cast<float>(shift[2])};
    const Lanes3 lanes{broadcast(q[0]), broadcast(q[1]), broadcast(q[2])};
    nearest.restart();
    if (guess != kNoBlock) offer_block(tree, guess, q, nearest);
    descend(tree, tree.n_levels - 1, 0, q, {lanes, lanes}, guess, nearest);
    for (std::size_t i = 0; i < k; ++i) slots[slot * k + i] = i < nearest.size() ? nearest[i].slot : kNoNeighbor;
    guess = nearest[0].slot / static_cast<std::uint32_t>(kBlockSize);
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
