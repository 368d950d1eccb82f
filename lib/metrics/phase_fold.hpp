#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/core/random_hash.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "grid_places.hpp"
#include "phased_frame.hpp"
#include "voxels.hpp"
#include "window_sums.hpp"

// The moments of both maps in every voxel of every phase of a grid, from one pass over the points: those of the parts
// of voxels are summed, and merged, without error, into the voxels of each phase. Cells of voxels are worked off one by
// one; what lies in two of them is put together at the end.

namespace cmap {

/// What a voxel of one phase holds of both maps.
template <class Moments>
struct PhaseVoxel {
  Moments reference{}, estimate{};

  /// Out of line: where compilers can see that sums are of one function they keep each word by itself.
  [[gnu::noinline]] PhaseVoxel& operator+=(const PhaseVoxel& other) {
    reference += other.reference;
    estimate += other.estimate;
    return *this;
  }
};

/// The points of one cell in both maps.
struct PairedCell {
  VoxelKey cell;
  BothSides<std::span<const CellRun>> runs;

  std::size_t n_points() const {
    std::size_t n = 0;
    for (const Side side : {Side::kEstimate, Side::kReference}) {
      for (const CellRun& run : runs.of(side)) n += run.end - run.begin;
    }
    return n;
  }
};

/// All cells of both maps, ordered.
std::vector<PairedCell> paired_cells(std::span<const CellRun> reference, std::span<const CellRun> estimate);

inline constexpr int kPhaseCellBits = 5;  ///< a cell's parts fit the second-level cache; larger ones have less border
inline constexpr std::uint64_t kHalvesSeed = 17;

/// Both maps of a pair.
inline BothSides<const IndexedMap*> maps_of(const MapPair& pair) { return {&pair.estimate, &pair.reference}; }

/// Folds the points of a pair of maps, or of one map.
/// `Source` has
///   Moments                                   a voxel's sums: add(terms), +=, -= and n(),
///   bool counts(map, slot)                    whether a point is summed,
///   terms(map, block, grid, places)           of the points of a block, by at(lane),
///   void to_frame(Moments&, VoxelKey)         where sums are about the corner of a voxel, makes them sums about the
///                                             corner of the frame's first, which can be merged,
///   bool halves                               whether a random half of the reference is asked for.
/// `Use`, one for each task, is a copy of `prototype` and has, once for each voxel,
///   void voxel(int phase, const VoxelKey&, const PhaseVoxel<Moments>&),
///   void halves(const VoxelKey&, const Moments& one, const Moments& other)  of the reference, in phase 0.
template <class Source, class Use>
class PhaseFold {
 public:
  using Moments = typename Source::Moments;

  /// A side without a map has no points.
  PhaseFold(const BothSides<const IndexedMap*>& maps, const PhasedFrame& frame, const Source& source)
      : maps_(maps),
        frame_(frame),
        source_(source),
        m_(frame.parts_per_axis()),
        edge_(kVoxels * m_ + m_ - 1),
        by_edge_(edge_),
        places_on_axis_(static_cast<std::size_t>(edge_)) {
    for (std::int32_t at = 0; at < edge_; ++at) {
      const std::int32_t shift = (m_ - 1 - at % m_) % m_, part = at - (m_ - 1);
      const std::int32_t key = (part + shift) / m_;
      const bool is_open = shift > 0 && (key == 0 || key == kVoxels);
      places_on_axis_[static_cast<std::size_t>(at)] = {shift, key, part / m_, is_open};
    }
  }

  std::vector<Use> run(const Use& prototype) const {
    const std::vector<CellRun> reference = runs_of(Side::kReference), estimate = runs_of(Side::kEstimate);
    const std::vector<PairedCell> cells = paired_cells(reference, estimate);
    const auto tasks = point_tasks(
        std::span<const PairedCell>(cells), [](const PairedCell& cell) { return cell.n_points(); },
        [](std::size_t) { return true; });
    std::vector<Use> used(tasks.size(), prototype);
    std::vector<OpenByPhase> open(tasks.size(), OpenByPhase(static_cast<std::size_t>(frame_.n_phases())));
    TablePool pool(edge_);
    parallel_chunks(tasks.size(), 1, [&](std::size_t i, std::size_t) {
      std::unique_ptr<Tables> tables = pool.take();
      for (const PairedCell& cell : tasks[i]) {
        sum_points(cell, *tables);
        list_parts(cell.cell, *tables);
        const auto use = [&](std::int32_t place, const Voxel& sums) {
          hand_out(cell.cell, place, sums, tables->half, used[i], open[i]);
        };
        m_ == 1 ? sum_voxels<1>(*tables, use) : m_ == 2 ? sum_voxels<2>(*tables, use) : sum_voxels<3>(*tables, use);
        tables->clear();
      }
      pool.give(std::move(tables));
    });
    close(open, prototype, used);
    return used;
  }

 private:
  using Voxel = PhaseVoxel<Moments>;
  static constexpr std::int32_t kVoxels = 1 << kPhaseCellBits;

  /// A voxel of which other cells may hold parts, too.
  struct OpenVoxel {
    VoxelKey key;
    Voxel sums;
  };
  using OpenByPhase = std::vector<std::vector<OpenVoxel>>;

  /// Of one place on an axis: the phase of the voxel of which it is the first part, and the keys in the cell of that
  /// voxel and of the one that holds the part in the grid that is not shifted.
  struct AxisPlace {
    std::int32_t shift, key, part_key;
    bool is_open;  ///< whether another cell may hold parts of that voxel, too
  };

  /// Divides places, by a product: a cell has less than 2^20 of them.
  class Divisor {
   public:
    explicit Divisor(std::int32_t by) : factor_((std::uint64_t{1} << kBits) / static_cast<std::uint64_t>(by) + 1) {}
    std::int32_t quotient(std::int32_t place) const {
      return static_cast<std::int32_t>(static_cast<std::uint64_t>(place) * factor_ >> kBits);
    }

   private:
    static constexpr int kBits = 40;
    std::uint64_t factor_;
  };

  /// Of one cell: the parts of voxels, in order, and windows of them on the first axis; the half of the reference by
  /// voxel.
  struct Tables {
    explicit Tables(std::int32_t edge) : parts(edge * edge * edge), half(kVoxels * kVoxels * kVoxels) {}
    void clear() {
      parts.clear();
      half.clear();
      ordered.clear();
      by_x.clear();
    }
    LocalGrid<Voxel> parts;
    LocalGrid<Moments> half;
    std::vector<PlacedSums<Voxel>> ordered, by_x;
  };

  /// Tables that tasks leave to each other: making them costs as much as some thousand points.
  class TablePool {
   public:
    explicit TablePool(std::int32_t edge) : edge_(edge) {}

    std::unique_ptr<Tables> take() {
      const std::lock_guard lock(mutex_);
      if (idle_.empty()) return std::make_unique<Tables>(edge_);
      std::unique_ptr<Tables> tables = std::move(idle_.back());
      idle_.pop_back();
      return tables;
    }
    void give(std::unique_ptr<Tables> tables) {
      const std::lock_guard lock(mutex_);
      idle_.push_back(std::move(tables));
    }

   private:
    std::int32_t edge_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Tables>> idle_;
  };

  std::vector<CellRun> runs_of(Side side) const {
    const IndexedMap* map = maps_.of(side);
    return map == nullptr ? std::vector<CellRun>{} : cell_runs(map->index, frame_.voxels(), kPhaseCellBits);
  }

  void sum_points(const PairedCell& cell, Tables& tables) const {
    for_points(Side::kEstimate, cell,
               [&](const IndexedMap&, std::size_t, const VoxelKey&, std::int32_t place, const auto& terms) {
                 tables.parts[place].estimate.add(terms);
               });
    for_points(
        Side::kReference, cell,
        [&](const IndexedMap& map, std::size_t slot, const VoxelKey& voxel, std::int32_t place, const auto& terms) {
          tables.parts[place].reference.add(terms);
          if (!source_.halves) return;
          if ((random_hash(map.index.points.original_index[slot], kHalvesSeed) & 1) == 0) return;
          constexpr std::int32_t kLocal = kVoxels - 1;
          tables.half[place_of({voxel.x & kLocal, voxel.y & kLocal, voxel.z & kLocal})].add(terms);
        });
  }

  /// Hands every point that counts to use(map, slot, voxel, place of its part, terms).
  template <class UsePoint>
  void for_points(Side side, const PairedCell& cell, UsePoint use) const {
    if (cell.runs.of(side).empty()) return;
    const IndexedMap& map = *maps_.of(side);
    const PointBlocks& points = map.index.points;
    const PartGrid grid = part_grid(points, frame_.voxels(), m_, kVoxels, m_ - 1);
    const auto use_block = [&](std::size_t slot, std::size_t end, const GridPlaces& places) {
      const auto terms = source_.terms(map, slot / kBlockSize, grid, places);
      for (; slot < end; ++slot) {
        if (!source_.counts(map, slot)) continue;
        const std::size_t lane = slot % kBlockSize;
        use(map, slot, VoxelKey{places.x[lane], places.y[lane], places.z[lane]}, places.in_cell[lane], terms.at(lane));
      }
    };
    for (const CellRun& run : cell.runs.of(side)) for_blocks(points, grid, run.begin, run.end, use_block);
  }

  static std::int32_t place_of(const VoxelKey& in_cell) {
    return (in_cell.x * kVoxels + in_cell.y) * kVoxels + in_cell.z;
  }

  void list_parts(const VoxelKey& cell, Tables& tables) const {
    tables.parts.in_order([&](std::int32_t place, const Voxel& sums) {
      Voxel& part = tables.ordered.emplace_back(PlacedSums<Voxel>{place, sums}).sums;
      const auto [x, y, z] = on_axes(place);
      const VoxelKey voxel = key_of(cell, {x.part_key, y.part_key, z.part_key});
      source_.to_frame(part.reference, voxel);
      source_.to_frame(part.estimate, voxel);
    });
  }

  /// Every window of m x m x m parts is a voxel of one phase: their sums, by the place of the first part.
  template <int kParts, class UseVoxel>
  void sum_voxels(Tables& tables, UseVoxel use) const {
    sum_windows<kParts>(std::span<const PlacedSums<Voxel>>(tables.ordered), edge_ * edge_,
                        [&](std::int32_t place, const Voxel& sums) {
                          tables.by_x.push_back({place, sums});
                        });
    RowWindows<kParts, Voxel> on_z;
    sum_windows<kParts>(std::span<const PlacedSums<Voxel>>(tables.by_x), edge_,
                        [&](std::int32_t place, const Voxel& sums) { on_z.add(place, sums, use); });
    on_z.finish(use);
  }

  void hand_out(const VoxelKey& cell, std::int32_t place, const Voxel& sums, const LocalGrid<Moments>& half, Use& use,
                OpenByPhase& open) const {
    const auto [x, y, z] = on_axes(place);
    const int phase = (x.shift * m_ + y.shift) * m_ + z.shift;
    const VoxelKey in_cell{x.key, y.key, z.key}, key = key_of(cell, in_cell);
    if (x.is_open || y.is_open || z.is_open) return open[static_cast<std::size_t>(phase)].push_back({key, sums});
    use.voxel(phase, key, sums);
    if (phase > 0 || !source_.halves) return;
    if (const Moments* half_here = half.find(place_of(in_cell))) {
      Moments one = *half_here, other = sums.reference;
      source_.to_frame(one, key);
      use.halves(key, one, other -= one);
    }
  }

  static VoxelKey key_of(const VoxelKey& cell, const VoxelKey& in_cell) {
    return {cell.x * kVoxels + in_cell.x, cell.y * kVoxels + in_cell.y, cell.z * kVoxels + in_cell.z};
  }

  std::array<AxisPlace, 3> on_axes(std::int32_t place) const {
    const std::int32_t row = by_edge_.quotient(place), x = by_edge_.quotient(row);
    const auto on_axis = [&](std::int32_t at) { return places_on_axis_[static_cast<std::size_t>(at)]; };
    return {on_axis(x), on_axis(row - x * edge_), on_axis(place - row * edge_)};
  }

  /// Puts the open voxels of all tasks together.
  void close(const std::vector<OpenByPhase>& by_task, const Use& prototype, std::vector<Use>& used) const {
    const std::size_t n_tasks = used.size();
    used.resize(n_tasks + static_cast<std::size_t>(frame_.n_phases()), prototype);
    parallel_chunks(used.size() - n_tasks, 1, [&](std::size_t phase, std::size_t) {
      VoxelMap<Voxel> voxels;
      for (const OpenByPhase& open : by_task) {
        for (const auto& [key, sums] : open[phase]) voxels[key] += sums;
      }
      for (const auto& [key, sums] : voxels.entries()) used[n_tasks + phase].voxel(static_cast<int>(phase), key, sums);
    });
  }

  BothSides<const IndexedMap*> maps_;
  const PhasedFrame& frame_;
  const Source& source_;
  std::int32_t m_;
  std::int32_t edge_;  ///< of the places of a cell: its parts, and before them where windows begin that end in it
  Divisor by_edge_;
  std::vector<AxisPlace> places_on_axis_;
};

}  // namespace cmap
