#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// A voxel, counted from the frame's base.
struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const VoxelKey&, const VoxelKey&) = default;
};

/// Voxels anchored at the world's origin: index floor(world / size) per axis, in double. Keys are relative to `base`
/// so that they stay small at UTM coordinates; base + key is the world's index.
class VoxelFrame {
 public:
  /// Throws UsageError where the box holds more than 2^31 voxels along an axis, std::invalid_argument if size <= 0.
  VoxelFrame(const Box3d& box, double size_m);

  double size_m() const { return size_m_; }

  VoxelKey key(const Eigen::Vector3d& world) const {
    return {axis_key(0, world.x()), axis_key(1, world.y()), axis_key(2, world.z())};
  }
  /// A key's coordinate on one axis.
  std::int32_t axis_key(int axis, double world) const {
    const double index = world / size_m_;
    const auto truncated = static_cast<std::int64_t>(index);
    return static_cast<std::int32_t>(truncated - (index < static_cast<double>(truncated) ? 1 : 0) - base_[axis]);
  }
  /// Of a world index in the box.
  VoxelKey key(const std::array<std::int64_t, 3>& index) const {
    return {static_cast<std::int32_t>(index[0] - base_[0]), static_cast<std::int32_t>(index[1] - base_[1]),
            static_cast<std::int32_t>(index[2] - base_[2])};
  }
  /// World index of the voxel.
  std::array<std::int64_t, 3> index(const VoxelKey& key) const {
    return {base_[0] + key.x, base_[1] + key.y, base_[2] + key.z};
  }
  Eigen::Vector3d center(const VoxelKey& key) const {
    const auto [x, y, z] = index(key);
    return (Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)).array() + 0.5) *
           size_m_;
  }

 private:
  double size_m_;
  std::int64_t base_[3];
};

/// A hash map from voxels to values, entries in order of first use; fastest when neighboring points follow each other.
/// Not thread-safe for writing.
template <class Value>
class VoxelMap {
 public:
  struct Entry {
    VoxelKey key;
    Value value;
  };

  VoxelMap() : table_(kFirstTable, kFree) {}

  Value& operator[](const VoxelKey& key) {
    if (last_ < entries_.size() && entries_[last_].key == key) return entries_[last_].value;
    if (2 * entries_.size() >= table_.size()) grow();
    std::size_t place = find_place(key);
    if (table_[place] == kFree) {
      table_[place] = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({key, Value{}});
    }
    last_ = table_[place];
    return entries_[last_].value;
  }

  const Value* find(const VoxelKey& key) const {
    const std::uint32_t entry = table_[find_place(key)];
    return entry == kFree ? nullptr : &entries_[entry].value;
  }

  const Array<Entry>& entries() const { return entries_; }

 private:
  static constexpr std::size_t kFirstTable = 64;
  static constexpr std::uint32_t kFree = ~0u;

  /// Sixteen neighboring voxels share a cache line of the table.
  static std::uint64_t hash(const VoxelKey& key) {
    const auto u = [](std::int32_t v) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)); };
    std::uint64_t h = (u(key.x) >> 1) * 0x9e3779b97f4a7c15ull ^ (u(key.y) >> 1) * 0xc2b2ae3d27d4eb4full ^
                      (u(key.z) >> 2) * 0x165667b19e3779f9ull;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93ull;
    return (h ^ h >> 32) << 4 | (u(key.x) & 1) << 3 | (u(key.y) & 1) << 2 | (u(key.z) & 3);
  }
  std::size_t find_place(const VoxelKey& key) const {
    std::size_t place = hash(key) & (table_.size() - 1);
    while (table_[place] != kFree && !(entries_[table_[place]].key == key)) place = (place + 1) & (table_.size() - 1);
    return place;
  }
  void grow() {
    Array<std::uint32_t> larger(2 * table_.size(), kFree);
    table_.swap(larger);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      table_[find_place(entries_[i].key)] = static_cast<std::uint32_t>(i);
  }

  Array<Entry> entries_;
  Array<std::uint32_t> table_;
  std::size_t last_ = 0;
};

/// The cloud thinned to one point per voxel: mean position and, where it has colors, mean color of the points that
/// have one (kept as float; NaN where none has).
/// Points are in the order in which their voxels first occur.
PointCloud voxel_thinned(const PointCloud& cloud, double voxel_m);

}  // namespace cmap
