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

  /// Whether is_it(slot) holds for any of them; ends at the first, in an order that is always the same: first those
  /// around `guess`, a slot whose point is likely to be near.
  template <class IsIt>
  bool any(const Eigen::Vector3f& place, std::size_t guess, IsIt is_it) const {
    const auto use = [&](std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        if (is_it(slot)) return true;
      }
      return false;
    };
    const Search from = search(place);
    return scan_block(from, guess / kBlockSize, use) || walk(from, use);
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
  bool walk(const Search& search, const Use& use) const {
    return walk_node(search, static_cast<int>(index_.boxes.size()) - 1, 0, use);
  }

  using Lanes = Eigen::Array<float, kBlockSize, 1>;
  /// Squared distances from a place to the nearest and the farthest point of sixteen boxes.
  struct BoxDistances {
    Lanes nearest, farthest;
  };
  static BoxDistances distances(const BoxNode& node, const Eigen::Vector3f& place) {
    BoxDistances found{Lanes::Zero(), Lanes::Zero()};
    const auto add = [&](const float(&min)[kBlockSize], const float(&max)[kBlockSize], float at) {
      const Lanes to_min = Eigen::Map<const Lanes>(min) - at, to_max = Eigen::Map<const Lanes>(max) - at;
      found.nearest += to_min.max(-to_max).max(0.0f).square();
      found.farthest += (-to_min).max(to_max).square();
    };
    add(node.min_x, node.max_x, place.x());
    add(node.min_y, node.max_y, place.y());
    add(node.min_z, node.max_z, place.z());
    return found;
  }

  /// Calls use(begin, end) for ranges of slots; true ends the walk.
  template <class Use>
  bool walk_node(const Search& search, int level, std::size_t node, const Use& use) const {
    const BoxDistances box = distances(index_.boxes[static_cast<std::size_t>(level)][node], search.float_place);
    for (std::size_t c = 0; c < kBlockSize; ++c) {
      const auto lane = static_cast<Eigen::Index>(c);
      if (!(box.nearest[lane] <= search.sq_near)) continue;  // absent ones, too: infinitely far
      const std::size_t child = node * kBlockSize + c;
      const bool ends = box.farthest[lane] <= search.sq_whole ? use_all(level, child, use)
                        : level == 0                          ? scan_block(search, child, use)
                                                              : walk_node(search, level - 1, child, use);
      if (ends) return true;
    }
    return false;
  }

  template <class Use>
  bool use_all(int level, std::size_t child, const Use& use) const {
    const std::size_t n_points = kBlockSize << (4 * level);
    return use(child * n_points, std::min((child + 1) * n_points, index_.points.size));
  }

  template <class Use>
  bool scan_block(const Search& search, std::size_t block, const Use& use) const {
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
