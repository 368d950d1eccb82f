// The most similar color within a radius, for sixteen queries at a time.

namespace cmap::CMAP_LANES {
namespace {

/// Squared color distances, with the same roundings on every instruction set; exact for 8-bit colors.
inline Float16 sq_color_dist(const Lanes3& color, float r, float g, float b) {
  const Float16 dr = color.x - broadcast(r);
  const Float16 dg = color.y - broadcast(g);
  const Float16 db = color.z - broadcast(b);
  return dr * dr + dg * dg + db * db;
}

/// Color boxes are entered up to this factor beyond the best color, for the rounding of their distances.
constexpr float kColorReach = static_cast<float>(1.0 + kRounding);

class ColorGroup {
 public:
  ColorGroup(const Tree& tree, const ColoredIndex& target, const ColorQueries& queries, const ColorSearch& search)
      : tree_(tree), colors_(target.colors.data()), queries_(queries), search_(search) {
    sq_radius_ = search.radius_m * search.radius_m;
    const double reach = search.radius_m + search.radius_steps * float_step(farthest_offset(target.index));
    sq_reach_ = reach * reach;
    sq_radius_surely_ = static_cast<float>(sq_radius_ * (1.0 - kRounding));
    sq_radius_perhaps_ = static_cast<float>(sq_reach_ * (1.0 + kRounding));
    for (int l = 0; l < tree.n_levels; ++l) color_boxes_[l] = target.color_boxes.data()[l].data();
  }

  /// The best color distances of a block of queries, a lane each.
  Float16 search(std::size_t block) {
    best_ = colors_of_nearest(block);
    active_ = less(broadcast(search_.stop_at), best_);
    if (bits(active_) == 0) return best_;  // most groups: the nearest points have the right colors
    query_block_ = &queries_.queries.points.blocks.data()[block];
    q_ = load_queries(*query_block_, queries_.queries.shift.data());
    const ColorBlock& color = queries_.colors.data()[block];
    color_ = {load(color.r), load(color.g), load(color.b)};
    scan_around_nearest(block);
    if (bits(active_) == 0) return best_;
    update_active();
    color_box_ = box_of(color_, active_);
    walk(tree_, box_of(q_, active_), *this);
    return best_;
  }

  Mask16 children(int level, std::uint32_t node, const Float16& sq_dist) const {
    const Float16 color_dist = sq_dist_to_children(color_boxes_[level][node], color_box_);
    return less_equal(sq_dist, broadcast(sq_radius_perhaps_)) & less(color_dist, broadcast(bound_ * kColorReach));
  }

  bool matters(int level, std::uint32_t node, int c) const {
    const Mask16 near =
        less_equal(sq_dist_to_child(tree_.boxes[level][node], c, q_), broadcast(sq_radius_perhaps_)) & active_;
    if (bits(near) == 0) return false;
    return bits(near & less(sq_dist_to_child(color_boxes_[level][node], c, color_), best_ * broadcast(kColorReach))) !=
           0;
  }

  void scan(std::uint32_t block) {
    const PointBlock& p = tree_.blocks[block];
    const ColorBlock& colors = colors_[block];
    bool lowered = false;
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      const Float16 sq_dist = sq_dist_to(q_, p.x[k], p.y[k], p.z[k]);
      const Mask16 perhaps = less_equal(sq_dist, broadcast(sq_radius_perhaps_)) & active_;
      const Float16 color_dist = sq_color_dist(color_, colors.r[k], colors.g[k], colors.b[k]);
      const Mask16 better = perhaps & less(color_dist, best_);
      if (bits(better) == 0) continue;
      const std::uint32_t surely = bits(less_equal(sq_dist, broadcast(sq_radius_surely_)));
      const Mask16 decided = mask_from_bits(bits(better) & (surely | within_in_double(bits(better) & ~surely, p, k)));
      best_ = select(decided, color_dist, best_);
      lowered = true;
    }
    if (lowered) update_active();
  }

 private:
  /// Where the search starts: the colors of the nearest points, kNoneWithin where those are too far.
  Float16 colors_of_nearest(std::size_t block) const {
    const ColorBlock& color = queries_.colors.data()[block];
    alignas(64) float best[16];
    for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
      const std::size_t i = block * kBlockSize + lane;
      best[lane] = kNoneWithin;
      if (i >= queries_.queries.points.size) continue;
      const std::uint32_t slot = queries_.nearest.slot.data()[i];
      const PointBlock& q = queries_.queries.points.blocks.data()[block];
      if (!is_near(queries_.nearest.sq_dist.data()[i], q, lane, tree_.blocks[slot / kBlockSize], slot % kBlockSize)) {
        continue;
      }
      const ColorBlock& nearest = colors_[slot / kBlockSize];
      const std::size_t k = slot % kBlockSize;
      const float dr = color.r[lane] - nearest.r[k];
      const float dg = color.g[lane] - nearest.g[k];
      const float db = color.b[lane] - nearest.b[k];
      const float sq_dist = dr * dr + dg * dg + db * db;
      best[lane] = sq_dist < search_.unless_below ? sq_dist : search_.unless_below;
    }
    return load(best);
  }

  /// The block around a nearest point mostly holds the right color, too.
  void scan_around_nearest(std::size_t block) {
    std::uint32_t scanned = kNoBlock;
    for (std::uint32_t todo = bits(active_); todo != 0; todo &= bits(active_)) {
      const std::size_t lane = static_cast<std::size_t>(first_bit(todo));
      todo &= todo - 1;
      const std::uint32_t around = queries_.nearest.slot.data()[block * kBlockSize + lane] / kBlockSize;
      if (around != scanned) scan(around);
      scanned = around;
    }
  }

  std::uint32_t within_in_double(std::uint32_t lanes, const PointBlock& p, std::size_t k) const {
    const double* shift = queries_.queries.shift.data();
    std::uint32_t within = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_bit(lanes);
      const double dx = (static_cast<double>(query_block_->x[lane]) - static_cast<double>(p.x[k])) + shift[0];
      const double dy = (static_cast<double>(query_block_->y[lane]) - static_cast<double>(p.y[k])) + shift[1];
      const double dz = (static_cast<double>(query_block_->z[lane]) - static_cast<double>(p.z[k])) + shift[2];
      const double sq_dist = dx * dx + dy * dy + dz * dz;
      if (is_near(sq_dist, *query_block_, static_cast<std::size_t>(lane), p, k)) within |= 1u << lane;
    }
    return within;
  }

  /// No two points within reach of each other have a larger coordinate.
  float farthest_offset(const Bvh& index) const {
    double shift = 0.0;
    for (int axis = 0; axis < 3; ++axis) shift += __builtin_fabs(queries_.queries.shift.data()[axis]);
    return largest_offset(index) + static_cast<float>(shift + 1.001 * search_.radius_m);
  }

  /// Whether a query and a point at this squared distance are within the radius.
  bool is_near(double sq_dist, const PointBlock& q, std::size_t lane, const PointBlock& p, std::size_t k) const {
    if (sq_dist <= sq_radius_ || sq_dist > sq_reach_) return sq_dist <= sq_radius_;
    const float offsets[] = {q.x[lane], q.y[lane], q.z[lane], p.x[k], p.y[k], p.z[k]};
    float largest = 0.0f;
    for (float v : offsets) largest = larger(largest, __builtin_fabsf(v));
    return is_within(sq_dist, search_.radius_m, search_.radius_steps, largest);
  }

  void update_active() {
    active_ = less(broadcast(search_.stop_at), best_);
    bound_ = highest(select(active_, best_, broadcast(-kInfinity)));
  }

  const Tree& tree_;
  const ColorBlock* colors_;
  const BoxNode* color_boxes_[8];
  const ColorQueries& queries_;
  const ColorSearch& search_;
  double sq_radius_;
  double sq_reach_;
  float sq_radius_surely_;
  float sq_radius_perhaps_;
  const PointBlock* query_block_ = nullptr;
  Lanes3 q_{};
  Lanes3 color_{};
  LaneBox color_box_{};
  Float16 best_{};
  Mask16 active_{};
  float bound_ = 0.0f;
};

void most_similar_color(const ColoredIndex& target, const ColorQueries& queries, const ColorSearch& search,
                        std::size_t begin, std::size_t end, Array<float>& best) {
  const Tree tree(target.index);
  ColorGroup group(tree, target, queries, search);
  alignas(64) float found[16];
  for (std::size_t block = begin; block < end; ++block) {
    store(found, group.search(block));
    const std::size_t n = queries.queries.points.size - block * kBlockSize;
    for (std::size_t lane = 0; lane < kBlockSize && lane < n; ++lane)
      best.data()[block * kBlockSize + lane] = found[lane];
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
