// What all searches share: groups of sixteen queries, their boxes, and the walk down the tree.
//
// Distances in float have a relative error below kRounding; whatever comes that close to a limit is decided again in
// double. So pruning is exact, and results do not depend on how an instruction set rounds.

namespace cmap::CMAP_LANES {
namespace {

constexpr float kInfinity = __builtin_inff();

/// Bound on the relative difference of two float squared distances that are equal in exact arithmetic: five roundings
/// of 2^-24 each.
constexpr double kRounding = 1e-6;

inline float larger(float a, float b) { return a < b ? b : a; }

struct Tree {
  explicit Tree(const Bvh& index)
      : blocks(index.points.blocks.data()),
        original_index(index.points.original_index.data()),
        n_blocks(index.points.blocks.size()),
        n_points(index.points.size),
        n_levels(static_cast<int>(index.boxes.size())) {
    for (int l = 0; l < n_levels; ++l) {
      boxes[l] = index.boxes[static_cast<std::size_t>(l)].data();
      lowest_index[l] = index.lowest_index[static_cast<std::size_t>(l)].data();
    }
  }

  const PointBlock* blocks;
  const std::uint32_t* original_index;
  std::size_t n_blocks;
  std::size_t n_points;
  int n_levels;
  const BoxNode* boxes[8];  // 16^8 blocks are 2^36 points
  const LowestIndex* lowest_index[8];

  int points_in(std::size_t block) const {
    return block + 1 == n_blocks ? static_cast<int>(n_points - block * kBlockSize) : static_cast<int>(kBlockSize);
  }
};

/// Three coordinates of sixteen points, or one value each for all lanes.
struct Lanes3 {
  Float16 x, y, z;
};

struct LaneBox {
  Lanes3 min, max;
};

inline Float16 sq_norm(const Float16& dx, const Float16& dy, const Float16& dz) {
  return multiply_add(dz, dz, multiply_add(dy, dy, dx * dx));
}

inline Float16 sq_dist_to(const Lanes3& q, float x, float y, float z) {
  return sq_norm(q.x - broadcast(x), q.y - broadcast(y), q.z - broadcast(z));
}

inline Float16 gap(const Float16& min_a, const Float16& max_a, const Float16& min_b, const Float16& max_b) {
  return max(max(min_a - max_b, min_b - max_a), broadcast(0.0f));
}

/// Squared distances between the node's sixteen children and one box.
inline Float16 sq_dist_to_children(const BoxNode& node, const LaneBox& box) {
  return sq_norm(gap(load(node.min_x), load(node.max_x), box.min.x, box.max.x),
                 gap(load(node.min_y), load(node.max_y), box.min.y, box.max.y),
                 gap(load(node.min_z), load(node.max_z), box.min.z, box.max.z));
}

inline Float16 gap_to(const Float16& v, float low, float high) {
  return v - min(max(v, broadcast(low)), broadcast(high));
}

/// Squared distances between sixteen queries and one child of the node.
inline Float16 sq_dist_to_child(const BoxNode& node, int c, const Lanes3& q) {
  return sq_norm(gap_to(q.x, node.min_x[c], node.max_x[c]), gap_to(q.y, node.min_y[c], node.max_y[c]),
                 gap_to(q.z, node.min_z[c], node.max_z[c]));
}

inline Lanes3 load_queries(const PointBlock& block, const double* shift) {
  return {load(block.x) + broadcast(static_cast<float>(shift[0])),
          load(block.y) + broadcast(static_cast<float>(shift[1])),
          load(block.z) + broadcast(static_cast<float>(shift[2]))};
}

/// The box of the active lanes, in all lanes.
inline LaneBox box_of(const Lanes3& q, Mask16 active) {
  const auto low = [&](const Float16& v) { return broadcast(lowest(select(active, v, broadcast(kInfinity)))); };
  const auto high = [&](const Float16& v) { return broadcast(highest(select(active, v, broadcast(-kInfinity)))); };
  return {{low(q.x), low(q.y), low(q.z)}, {high(q.x), high(q.y), high(q.z)}};
}

inline int first_bit(std::uint32_t bits_set) { return __builtin_ctz(bits_set); }

/// Walks down to the blocks that may matter, in the order of the curve. `reach` has
///   Mask16 children(level, node, sq_dist)   which children may matter, by their distances to the group's box,
///   bool matters(level, node, c)            whether child c of the node matters to any single lane,
///   void scan(block)                        what to do with a block that does.
template <class Reach>
inline void walk(const Tree& tree, const LaneBox& box, Reach& reach) {
  struct Open {
    std::uint32_t node;
    std::uint32_t left;  ///< children not yet visited
  };
  Open open[8];
  int level = tree.n_levels - 1;
  const auto enter = [&](std::uint32_t node) {
    open[level] = {node, bits(reach.children(level, node, sq_dist_to_children(tree.boxes[level][node], box)))};
  };
  enter(0);
  while (level < tree.n_levels) {
    Open& top = open[level];
    if (top.left == 0) {
      ++level;
      continue;
    }
    const int c = first_bit(top.left);
    top.left &= top.left - 1;
    if (!reach.matters(level, top.node, c)) continue;
    const std::uint32_t child = top.node * static_cast<std::uint32_t>(kBlockSize) + static_cast<std::uint32_t>(c);
    if (level == 0) {
      reach.scan(child);
    } else {
      --level;
      enter(child);
    }
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
