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
  ColorGroup(const Tree& tree, const ColorBlock* colors, const BoxLevels& color_boxes, const ColorSearch& search)
      : tree_(tree), colors_(colors), sq_radius_(search.radius_m * search.radius_m), stop_at_(search.stop_at) {
    sq_radius_surely_ = static_cast<float>(sq_radius_ * (1.0 - kRounding));
    sq_radius_perhaps_ = static_cast<float>(sq_radius_ * (1.0 + kRounding));
    for (int l = 0; l < tree.n_levels; ++l) color_boxes_[l] = color_boxes.data()[l].data();
  }

  void search(const PointBlock& query_block, const double* shift, const Lanes3& queries, const ColorBlock& query_colors,
              float* best) {
    query_block_ = &query_block;
    shift_ = shift;
    q_ = queries;
    color_ = {load(query_colors.r), load(query_colors.g), load(query_colors.b)};
    best_ = load(best);
    update_active();
    if (bits(active_) == 0) return;
    color_box_ = box_of(color_, active_);
    walk(tree_, box_of(q_, active_), *this);
    store(best, best_);
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
      if (bits(perhaps) == 0) continue;
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
  std::uint32_t within_in_double(std::uint32_t lanes, const PointBlock& p, std::size_t k) const {
    std::uint32_t within = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_bit(lanes);
      const double dx = (static_cast<double>(query_block_->x[lane]) - static_cast<double>(p.x[k])) + shift_[0];
      const double dy = (static_cast<double>(query_block_->y[lane]) - static_cast<double>(p.y[k])) + shift_[1];
      const double dz = (static_cast<double>(query_block_->z[lane]) - static_cast<double>(p.z[k])) + shift_[2];
      if (dx * dx + dy * dy + dz * dz <= sq_radius_) within |= 1u << lane;
    }
    return within;
  }

  void update_active() {
    active_ = less(broadcast(stop_at_), best_);
    bound_ = highest(select(active_, best_, broadcast(-kInfinity)));
  }

  const Tree& tree_;
  const ColorBlock* colors_;
  const BoxNode* color_boxes_[8];
  double sq_radius_;
  float sq_radius_surely_;
  float sq_radius_perhaps_;
  float stop_at_;
  const PointBlock* query_block_ = nullptr;
  const double* shift_ = nullptr;
  Lanes3 q_{};
  Lanes3 color_{};
  LaneBox color_box_{};
  Float16 best_{};
  Mask16 active_{};
  float bound_ = 0.0f;
};

void lower_color_distance(const Bvh& index, const Array<ColorBlock>& index_colors, const BoxLevels& index_color_boxes,
                          const Queries& queries, const Array<ColorBlock>& query_colors, const ColorSearch& search,
                          std::size_t begin, std::size_t end, Array<float>& best) {
  const Tree tree(index);
  ColorGroup group(tree, index_colors.data(), index_color_boxes, search);
  for (std::size_t block = begin; block < end; ++block) {
    const PointBlock& points = queries.points.blocks.data()[block];
    group.search(points, queries.shift.data(), load_queries(points, queries.shift), query_colors.data()[block],
                 best.data() + block * kBlockSize);
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
