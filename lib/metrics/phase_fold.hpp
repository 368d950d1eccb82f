#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/core/random_hash.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "grid_places.hpp"
#include "phased_frame.hpp"
#include "voxels.hpp"

// The moments of both maps in every voxel of every phase of a grid, from one pass over the points: those of the parts
// of voxels are summed, and merged, without error, into the voxels of each phase. Cells of voxels are worked off one by
// one; what lies in two of them is put together at the end.

namespace cmap {

/// What a voxel of one phase holds of both maps.
template <class Moments>
struct PhaseVoxel {
  Moments reference{}, estimate{};
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
///   Moments                                                a voxel's sums: +=, and n(),
///   bool counts(map, slot)                                 whether a point is summed,
///   void add(Moments&, map, slot, VoxelKey)                adds it,
///   bool kHasCorners                                       whether sums are about the corners of voxels,
///   void merge(Moments&, const Moments& part)              adds those of a part; with corners, of a part that a phase
///                                                          shifts, on each axis, into so many voxels after its own:
///                                                          merge(Moments&, part, shift, after),
///   bool halves                                            whether a random half of the reference is asked for.
/// `Use`, one for each task, is a copy of `prototype` and has, once for each voxel,
///   void voxel(int phase, const VoxelIndex&, const PhaseVoxel<Moments>&),
///   void halves(const Moments& one, const Moments& other)  of the reference, in phase 0.
template <class Source, class Use>
class PhaseFold {
 public:
  using Moments = typename Source::Moments;

  /// A side without a map has no points.
  PhaseFold(const BothSides<const IndexedMap*>& maps, const PhasedFrame& frame, const Source& source)
      : maps_(maps), frame_(frame), source_(source) {
    const std::int32_t m = frame.parts_per_axis();
    for (std::int32_t k = 0; k < m; ++k) {
      for (std::int32_t part = 0; part < kVoxels * m; ++part) voxel_of_part_[k][part] = (part + k) / m;
    }
  }

  std::vector<Use> run(const Use& prototype) const {
    const std::vector<CellRun> reference = runs_of(Side::kReference), estimate = runs_of(Side::kEstimate);
    const std::vector<PairedCell> cells = paired_cells(reference, estimate);
    const auto tasks = point_tasks(
        std::span<const PairedCell>(cells), [](const PairedCell& cell) { return cell.n_points(); },
        [](std::size_t) { return true; });
    std::vector<Use> used(tasks.size(), prototype);
    std::vector<std::vector<OpenVoxel>> open(tasks.size());
    TablePool pool(frame_.parts_per_axis());
    parallel_chunks(tasks.size(), 1, [&](std::size_t i, std::size_t) {
      std::unique_ptr<Tables> tables = pool.take();
      for (const PairedCell& cell : tasks[i]) {
        sum_points(cell, *tables);
        if (source_.halves) take_halves(*tables, used[i]);
        for (int phase = 0; phase < frame_.n_phases(); ++phase) hand_out(phase, cell.cell, *tables, used[i], open[i]);
        tables->clear();
      }
      pool.give(std::move(tables));
    });
    close(open, prototype, used);
    return used;
  }

 private:
  static constexpr std::int32_t kVoxels = 1 << kPhaseCellBits;

  /// A voxel of which other cells may hold parts, too.
  struct OpenVoxel {
    int phase;
    VoxelIndex index;
    PhaseVoxel<Moments> sums;
    auto order() const { return std::tie(phase, index[0], index[1], index[2]); }
  };

  /// Of one cell: the parts of voxels, by where they lie, and voxels of one phase.
  struct Tables {
    explicit Tables(int m)
        : reference(kVoxels * m), estimate(kVoxels * m), half(kVoxels * m), voxels(kVoxels + 1), halves(kVoxels + 1) {}
    void clear() {
      reference.clear();
      estimate.clear();
    }
    LocalGrid<Moments> reference, estimate;
    LocalGrid<Moments> half;  ///< of the reference, as long as it is apart
    LocalGrid<PhaseVoxel<Moments>> voxels;
    LocalGrid<std::array<Moments, 2>> halves;
  };

  /// Tables that tasks leave to each other: making them costs as much as some thousand points.
  class TablePool {
   public:
    explicit TablePool(int parts_per_axis) : parts_per_axis_(parts_per_axis) {}

    std::unique_ptr<Tables> take() {
      const std::lock_guard lock(mutex_);
      if (idle_.empty()) return std::make_unique<Tables>(parts_per_axis_);
      std::unique_ptr<Tables> tables = std::move(idle_.back());
      idle_.pop_back();
      return tables;
    }
    void give(std::unique_ptr<Tables> tables) {
      const std::lock_guard lock(mutex_);
      idle_.push_back(std::move(tables));
    }

   private:
    int parts_per_axis_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Tables>> idle_;
  };

  std::vector<CellRun> runs_of(Side side) const {
    const IndexedMap* map = maps_.of(side);
    return map == nullptr ? std::vector<CellRun>{} : cell_runs(map->index, frame_.voxels(), kPhaseCellBits);
  }

  void sum_points(const PairedCell& cell, Tables& tables) const {
    for_points(
        Side::kEstimate, cell, [&](std::size_t) -> auto& { return tables.estimate; });
    if (!source_.halves) {
      for_points(
          Side::kReference, cell, [&](std::size_t) -> auto& { return tables.reference; });
      return;
    }
    for_points(
        Side::kReference, cell, [&](std::size_t slot) -> auto& {
          const std::uint32_t original = maps_.reference->index.points.original_index[slot];
          return random_hash(original, kHalvesSeed) & 1 ? tables.half : tables.reference;
        });
  }

  /// Adds every point to the table that table_of(slot) gives.
  template <class TableOf>
  void for_points(Side side, const PairedCell& cell, TableOf table_of) const {
    if (cell.runs.of(side).empty()) return;
    const IndexedMap& map = *maps_.of(side);
    const PointBlocks& points = map.index.points;
    const PartGrid grid = part_grid(points, frame_.voxels(), frame_.parts_per_axis(), kVoxels);
    for (const CellRun& run : cell.runs.of(side)) {
      for_places(points, grid, run.begin, run.end, [&](std::size_t slot, const VoxelKey& voxel, std::int32_t place) {
        if (source_.counts(map, slot)) source_.add(table_of(slot).at_place(place), map, slot, voxel);
      });
    }
  }

  /// Hands both halves of the reference out, and puts them together.
  void take_halves(Tables& tables, Use& use) const {
    const auto gather = [&](const LocalGrid<Moments>& parts, std::size_t half) {
      for (const auto& [part, moments] : parts.entries()) {
        tables.halves[voxel_of(part, {0, 0, 0})][half] += moments;
      }
    };
    gather(tables.half, 0);
    gather(tables.reference, 1);
    for (const auto& [at, halves] : tables.halves.entries()) use.halves(halves[0], halves[1]);
    tables.halves.clear();
    for (const auto& [part, moments] : tables.half.entries()) tables.reference[part] += moments;
    tables.half.clear();
  }

  /// The voxel, counted from the cell's corner, that holds a part in a phase with such a shift.
  LocalKey voxel_of(const LocalKey& part, const LocalKey& shift) const {
    LocalKey voxel;
    for (std::size_t axis = 0; axis < 3; ++axis) voxel[axis] = voxel_of_part_[shift[axis]][part[axis]];
    return voxel;
  }

  void hand_out(int phase, const VoxelKey& cell, Tables& tables, Use& use, std::vector<OpenVoxel>& open) const {
    const LocalKey shift = frame_.shift(phase);
    merge(tables.reference, shift, tables.voxels, &PhaseVoxel<Moments>::reference);
    merge(tables.estimate, shift, tables.voxels, &PhaseVoxel<Moments>::estimate);
    for (const auto& [at, sums] : tables.voxels.entries()) {
      bool is_open = false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        is_open = is_open || (shift[axis] > 0 && (at[axis] == 0 || at[axis] == kVoxels));
      }
      const VoxelIndex index =
          frame_.voxels().index(VoxelKey{cell.x * kVoxels + at[0], cell.y * kVoxels + at[1], cell.z * kVoxels + at[2]});
      if (is_open) {
        open.push_back({phase, index, sums});
      } else {
        use.voxel(phase, index, sums);
      }
    }
    tables.voxels.clear();
  }

  void merge(const LocalGrid<Moments>& parts, const LocalKey& shift, LocalGrid<PhaseVoxel<Moments>>& voxels,
             Moments PhaseVoxel<Moments>::*side) const {
    for (const auto& [part, moments] : parts.entries()) {
      const LocalKey at = voxel_of(part, shift);
      Moments& into = voxels[at].*side;
      if constexpr (Source::kHasCorners) {
        const LocalKey own = voxel_of(part, {0, 0, 0});
        source_.merge(into, moments, shift, {at[0] - own[0], at[1] - own[1], at[2] - own[2]});
      } else {
        source_.merge(into, moments);
      }
    }
  }

  /// Puts the open voxels of all tasks together.
  void close(const std::vector<std::vector<OpenVoxel>>& by_task, const Use& prototype, std::vector<Use>& used) const {
    std::vector<const OpenVoxel*> open;
    for (const auto& voxels : by_task) {
      for (const OpenVoxel& voxel : voxels) open.push_back(&voxel);
    }
    std::ranges::sort(open, {}, [](const OpenVoxel* voxel) { return voxel->order(); });
    Use rest = prototype;
    for (auto first = open.begin(); first != open.end();) {
      PhaseVoxel<Moments> sums = (*first)->sums;
      auto next = std::next(first);
      for (; next != open.end() && (*next)->order() == (*first)->order(); ++next) {
        sums.reference += (*next)->sums.reference;
        sums.estimate += (*next)->sums.estimate;
      }
      rest.voxel((*first)->phase, (*first)->index, sums);
      first = next;
    }
    used.push_back(std::move(rest));
  }

  BothSides<const IndexedMap*> maps_;
  const PhasedFrame& frame_;
  const Source& source_;
  std::int32_t voxel_of_part_[3][3 * kVoxels] = {};  ///< by shift and part of a cell, on an axis
};

}  // namespace cmap
