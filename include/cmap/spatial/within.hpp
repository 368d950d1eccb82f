#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/threshold.hpp"

namespace cmap {

/// The points of an index within a radius of single places, decided in double; a distance counts as at the radius as
/// spatial/threshold.hpp says. For a sample of places: whole maps have kernels (spatial/radius.hpp). Thread-safe.
class PointsWithin {
 public:
  explicit PointsWithin(const Bvh& index, double radius_m, double radius_steps = kThresholdSteps)
      : index_(index), radius_m_(radius_m), steps_(radius_steps), largest_(largest_offset(index)) {}

  /// How many there are; `place` is an offset from the index's origin.
  std::uint64_t count(const Eigen::Vector3f& place) const {
    std::uint64_t n = 0;
    const auto whole = [&](std::size_t begin, std::size_t end) {
      n += end - begin;
      return false;
    };
    walk(search(place), whole);
    return n;
  }

  /// Whether is_it(slot) holds for any of them; ends at the first, in an order that is always the same.
  template <class IsIt>
  bool any(const Eigen::Vector3f& place, IsIt is_it) const {
    return walk(search(place), [&](std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        if (is_it(slot)) return true;
      }
      return false;
    });
  }

 private:
  struct Search {
    Eigen::Vector3d place;
    Eigen::Vector3f float_place;
    double sq_radius, sq_reach;  ///< surely within, surely not
    float sq_whole, sq_near;     ///< the same of boxes in single precision, on the safe side
  };

  Search search(const Eigen::Vector3f& place) const {
    constexpr double kRounding = 1e-5;  // some of 2^-24 each
    const float largest = std::max(largest_, place.cwiseAbs().maxCoeff());
    const double reach_m = radius_m_ + steps_ * float_step(largest);
    const double sq_radius = radius_m_ * radius_m_, sq_reach = 1.0000001 * reach_m * reach_m;
    return {place.cast<double>(),
            place,
            sq_radius,
            sq_reach,
            static_cast<float>(sq_radius * (1.0 - kRounding)),
            static_cast<float>(sq_reach * (1.0 + kRounding))};
  }

  template <class Use>
  bool walk(const Search& search, Use use) const {
    return walk_node(search, static_cast<int>(index_.boxes.size()) - 1, 0, use);
  }

  /// Squared distances from a place to the nearest and the farthest point of sixteen boxes.
  struct BoxDistances {
    float nearest[kBlockSize], farthest[kBlockSize];
  };
  static BoxDistances distances(const BoxNode& node, const Eigen::Vector3f& place) {
    BoxDistances found;
    const float x = place.x(), y = place.y(), z = place.z();
    for (std::size_t c = 0; c < kBlockSize; ++c) {
      const float x0 = node.min_x[c] - x, x1 = node.max_x[c] - x, y0 = node.min_y[c] - y, y1 = node.max_y[c] - y;
      const float z0 = node.min_z[c] - z, z1 = node.max_z[c] - z;
      const float gx = std::max(std::max(x0, -x1), 0.0f), gy = std::max(std::max(y0, -y1), 0.0f);
      const float gz = std::max(std::max(z0, -z1), 0.0f);
      const float fx = std::max(-x0, x1), fy = std::max(-y0, y1), fz = std::max(-z0, z1);
      found.nearest[c] = gx * gx + gy * gy + gz * gz;
      found.farthest[c] = fx * fx + fy * fy + fz * fz;
    }
    return found;
  }

  /// Calls use(begin, end) for ranges of slots; true ends the walk.
  template <class Use>
  bool walk_node(const Search& search, int level, std::size_t node, Use& use) const {
    const BoxDistances box = distances(index_.boxes[static_cast<std::size_t>(level)][node], search.float_place);
    for (std::size_t c = 0; c < kBlockSize; ++c) {
      if (!(box.nearest[c] <= search.sq_near)) continue;  // absent ones, too: infinitely far
      const std::size_t child = node * kBlockSize + c;
      const bool ends = box.farthest[c] <= search.sq_whole ? use_all(level, child, use)
                        : level == 0                       ? scan_block(search, child, use)
                                                           : walk_node(search, level - 1, child, use);
      if (ends) return true;
    }
    return false;
  }

  template <class Use>
  bool use_all(int level, std::size_t child, Use& use) const {
    const std::size_t n_points = kBlockSize << (4 * level);
    return use(child * n_points, std::min((child + 1) * n_points, index_.points.size));
  }

  template <class Use>
  bool scan_block(const Search& search, std::size_t block, Use& use) const {
    const std::size_t end = std::min((block + 1) * kBlockSize, index_.points.size);
    for (std::size_t slot = block * kBlockSize; slot < end; ++slot) {
      const Eigen::Vector3f offset = index_.points.offset(slot);
      const double sq_dist = (offset.cast<double>() - search.place).squaredNorm();
      if (sq_dist > search.sq_reach) continue;
      if (sq_dist > search.sq_radius &&
          !is_within(sq_dist, radius_m_, steps_,
                     search.float_place.cwiseAbs().cwiseMax(offset.cwiseAbs()).maxCoeff())) {
        continue;
      }
      if (use(slot, slot + 1)) return true;
    }
    return false;
  }

  const Bvh& index_;
  double radius_m_, steps_;
  float largest_;
};

}  // namespace cmap
