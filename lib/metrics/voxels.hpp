#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/voxel_map.hpp"

namespace cmap {

/// Sums over the points of every voxel of a sorted cloud, and what becomes of them.
///
/// A chunk of neighboring points sums into a small map of its own; a voxel that no other chunk can reach is finished at
/// once, and only the voxels on the chunks' borders meet in a common map. So memory stays small, chunks run in
/// parallel, and the result depends on neither.
template <class Sums, class AddPoint, class Finish>
class VoxelCollector {
 public:
  using Result = typename std::invoke_result_t<Finish, const VoxelKey&, const Sums&>::value_type;

  /// add(sums, slot, world, key) adds a point; finish(key, sums) is the voxel's result or none. Sums has operator+=.
  VoxelCollector(const PointBlocks& points, const VoxelFrame& frame, AddPoint add, Finish finish)
      : points_(points), frame_(frame), add_(std::move(add)), finish_(std::move(finish)) {}

  struct Collected {
    std::vector<Result> results;
    std::uint64_t n_without_result = 0;
  };

  Collected collect() {
    const std::size_t n_chunks = (points_.size + kChunk - 1) / kChunk;
    boxes_.resize(n_chunks);
    parts_.resize(n_chunks);
    parallel_chunks(points_.size, kChunk, [&](std::size_t begin, std::size_t end) { boxes_[begin / kChunk] = key_box(begin, end); });
    parallel_chunks(points_.size, kChunk, [&](std::size_t begin, std::size_t end) { sum_chunk(begin, end); });

    Collected all;
    VoxelMap<Sums> border;
    for (Part& part : parts_) {
      all.results.insert(all.results.end(), part.inner.results.begin(), part.inner.results.end());
      all.n_without_result += part.inner.n_without_result;
      for (const auto& entry : part.border) border[entry.key] += entry.value;
    }
    for (const auto& entry : border.entries()) finish_into(all, entry);
    return all;
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 15;

  using Entry = typename VoxelMap<Sums>::Entry;

  struct KeyBox {
    VoxelKey min, max;
    bool holds(const VoxelKey& k) const {
      return k.x >= min.x && k.x <= max.x && k.y >= min.y && k.y <= max.y && k.z >= min.z && k.z <= max.z;
    }
    bool meets(const KeyBox& o) const {
      return min.x <= o.max.x && o.min.x <= max.x && min.y <= o.max.y && o.min.y <= max.y && min.z <= o.max.z && o.min.z <= max.z;
    }
  };

  struct Part {
    Collected inner;
    std::vector<Entry> border;
  };

  KeyBox key_box(std::size_t begin, std::size_t end) const {
    Eigen::Vector3f low = points_.offset(begin);
    Eigen::Vector3f high = low;
    for (std::size_t slot = begin + 1; slot < end; ++slot) {
      low = low.cwiseMin(points_.offset(slot));
      high = high.cwiseMax(points_.offset(slot));
    }
    return {frame_.key(points_.origin + low.cast<double>()), frame_.key(points_.origin + high.cast<double>())};
  }

  void sum_chunk(std::size_t begin, std::size_t end) {
    VoxelMap<Sums> voxels;
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Eigen::Vector3d world = points_.world(slot);
      const VoxelKey key = frame_.key(world);
      add_(voxels[key], slot, world, key);
    }
    const std::size_t chunk = begin / kChunk;
    std::vector<KeyBox> others;
    for (std::size_t c = 0; c < boxes_.size(); ++c) {
      if (c != chunk && boxes_[c].meets(boxes_[chunk])) others.push_back(boxes_[c]);
    }
    Part& part = parts_[chunk];
    for (const Entry& entry : voxels.entries()) {
      const bool shared = std::ranges::any_of(others, [&](const KeyBox& box) { return box.holds(entry.key); });
      if (shared) {
        part.border.push_back(entry);
      } else {
        finish_into(part.inner, entry);
      }
    }
  }

  void finish_into(Collected& collected, const Entry& entry) const {
    if (auto result = finish_(entry.key, entry.value)) {
      collected.results.push_back(std::move(*result));
    } else {
      ++collected.n_without_result;
    }
  }

  const PointBlocks& points_;
  const VoxelFrame& frame_;
  AddPoint add_;
  Finish finish_;
  std::vector<KeyBox> boxes_;
  std::vector<Part> parts_;
};

template <class Sums, class AddPoint, class Finish>
auto collect_voxels(const PointBlocks& points, const VoxelFrame& frame, AddPoint add, Finish finish) {
  return VoxelCollector<Sums, AddPoint, Finish>(points, frame, std::move(add), std::move(finish)).collect();
}

}  // namespace cmap
