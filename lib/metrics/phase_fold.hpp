#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/core/random_hash.hpp"
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
///   Moments                                   a voxel's sums: +=, -= and n(),
///   bool counts(map, slot)                    whether a point is summed,
///   void add(Moments&, map, slot, VoxelKey)   adds it,
///   bool kHasCorners                          whether sums are about the corners of voxels; then
///   void merge(Moments&, const Moments& part, int axis, int shift, int after)
///                                             adds those of a part that a phase shifts, on this axis, into so many
///                                             voxels after its own,
///   bool halves                               whether a random half of the reference is asked for.
/// `Use`, one for each task, is a copy of `prototype` and has, once for each voxel,
///   void voxel(int phase, const VoxelIndex&, const PhaseVoxel<Moments>&),
///   void halves(const Moments& one, const Moments& other)  of the reference, in phase 0.
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
        voxel_on_axis_(static_cast<std::size_t>(edge_)) {
    for (std::int32_t at = 0; at < edge_; ++at) {
      const std::int32_t shift = (m_ - 1 - at % m_) % m_;
      voxel_on_axis_[static_cast<std::size_t>(at)] = {shift, (at - (m_ - 1) + shift) / m_};
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
    TablePool pool(edge_);
    parallel_chunks(tasks.size(), 1, [&](std::size_t i, std::size_t) {
      std::unique_ptr<Tables> tables = pool.take();
      for (const PairedCell& cell : tasks[i]) {
        sum_points(cell, *tables);
        sum_voxels(*tables, [&](std::int32_t place, const Voxel& sums) {
          hand_out(cell.cell, place, sums, tables->half, used[i], open[i]);
        });
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
    int phase;
    VoxelKey key;
    Voxel sums;
    /// By phase and key: keys are not negative.
    std::array<std::uint64_t, 2> order() const {
      const auto words = [](std::int64_t high, std::int64_t low) {
        return static_cast<std::uint64_t>(high << 32 | low);
      };
      return {words(phase, key.x), words(key.y, key.z)};
    }
  };

  /// On an axis, by place of its first part: a voxel's phase, and its key in the cell.
  struct AxisVoxel {
    std::int32_t shift, key;
  };

  /// Of one cell: the parts of voxels, and what becomes of them axis by axis; the half of the reference by voxel.
  struct Tables {
    explicit Tables(std::int32_t edge) : parts(edge * edge * edge), half(kVoxels * kVoxels * kVoxels) {}
    void clear() {
      parts.clear();
      half.clear();
      ordered.clear();
      by_x.clear();
      by_y.clear();
    }
    LocalGrid<Voxel> parts;
    LocalGrid<Moments> half;
    std::vector<PlacedSums<Voxel>> ordered, by_x, by_y;
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
               [&](const IndexedMap& map, std::size_t slot, const VoxelKey& voxel, std::int32_t place) {
                 source_.add(tables.parts[place].estimate, map, slot, voxel);
               });
    for_points(
        Side::kReference, cell,
        [&](const IndexedMap& map, std::size_t slot, const VoxelKey& voxel, std::int32_t place) {
          source_.add(tables.parts[place].reference, map, slot, voxel);
          if (!source_.halves || (random_hash(map.index.points.original_index[slot], kHalvesSeed) & 1) == 0) return;
          constexpr std::int32_t kLocal = kVoxels - 1;
          source_.add(tables.half[place_of({voxel.x & kLocal, voxel.y & kLocal, voxel.z & kLocal})], map, slot, voxel);
        });
  }

  /// Hands every point that counts to use(map, slot, voxel, place of its part).
  template <class UsePoint>
  void for_points(Side side, const PairedCell& cell, UsePoint use) const {
    if (cell.runs.of(side).empty()) return;
    const IndexedMap& map = *maps_.of(side);
    const PointBlocks& points = map.index.points;
    const PartGrid grid = part_grid(points, frame_.voxels(), m_, kVoxels, m_ - 1);
    for (const CellRun& run : cell.runs.of(side)) {
      for_places(points, grid, run.begin, run.end, [&](std::size_t slot, const VoxelKey& voxel, std::int32_t place) {
        if (source_.counts(map, slot)) use(map, slot, voxel, place);
      });
    }
  }

  static std::int32_t place_of(const VoxelKey& in_cell) {
    return (in_cell.x * kVoxels + in_cell.y) * kVoxels + in_cell.z;
  }

  /// Every window of m x m x m parts is a voxel of one phase: their sums, by the place of the first part.
  template <class UseVoxel>
  void sum_voxels(Tables& tables, UseVoxel use) const {
    if (m_ == 1) return tables.parts.in_order(use);
    tables.parts.in_order([&](std::int32_t place, const Voxel& sums) { tables.ordered.push_back({place, sums}); });
    const auto append_to = [](std::vector<PlacedSums<Voxel>>& windows) {
      return [&windows](std::int32_t place, const Voxel& sums) { windows.push_back({place, sums}); };
    };
    sum_windows_on(0, tables.ordered, append_to(tables.by_x));
    sum_windows_on(1, tables.by_x, append_to(tables.by_y));
    sum_windows_on(2, tables.by_y, use);
  }

  template <class Emit>
  void sum_windows_on(int axis, std::span<const PlacedSums<Voxel>> parts, Emit emit) const {
    const std::int32_t stride = axis == 0 ? edge_ * edge_ : axis == 1 ? edge_ : 1;
    const auto merge = [&](Voxel& into, const PlacedSums<Voxel>& part, std::int32_t window) {
      if constexpr (Source::kHasCorners) {
        const auto [shift, key] = voxel_on_axis_[static_cast<std::size_t>(window / stride % edge_)];
        const int after = key - (part.place / stride % edge_ - (m_ - 1)) / m_;
        source_.merge(into.reference, part.sums.reference, axis, shift, after);
        source_.merge(into.estimate, part.sums.estimate, axis, shift, after);
      } else {
        into.reference += part.sums.reference;
        into.estimate += part.sums.estimate;
      }
    };
    m_ == 2 ? sum_windows<2>(parts, stride, merge, emit) : sum_windows<3>(parts, stride, merge, emit);
  }

  void hand_out(const VoxelKey& cell, std::int32_t place, const Voxel& sums, const LocalGrid<Moments>& half, Use& use,
                std::vector<OpenVoxel>& open) const {
    const std::array<AxisVoxel, 3> on_axis{voxel_on_axis_[static_cast<std::size_t>(place / (edge_ * edge_))],
                                           voxel_on_axis_[static_cast<std::size_t>(place / edge_ % edge_)],
                                           voxel_on_axis_[static_cast<std::size_t>(place % edge_)]};
    const auto [x, y, z] = on_axis;
    const int phase = (x.shift * m_ + y.shift) * m_ + z.shift;
    const VoxelKey key{cell.x * kVoxels + x.key, cell.y * kVoxels + y.key, cell.z * kVoxels + z.key};
    const auto at_border = [](const AxisVoxel& v) { return v.shift > 0 && (v.key == 0 || v.key == kVoxels); };
    if (std::ranges::any_of(on_axis, at_border)) return open.push_back({phase, key, sums});
    use.voxel(phase, frame_.voxels().index(key), sums);
    if (phase > 0 || !source_.halves) return;
    if (const Moments* one = half.find(place_of({x.key, y.key, z.key}))) {
      Moments other = sums.reference;
      use.halves(*one, other -= *one);
    }
  }

  /// Puts the open voxels of all tasks together.
  void close(const std::vector<std::vector<OpenVoxel>>& by_task, const Use& prototype, std::vector<Use>& used) const {
    struct Ordered {
      std::array<std::uint64_t, 2> order;
      const OpenVoxel* voxel;
    };
    std::vector<Ordered> open;
    for (const auto& voxels : by_task) {
      for (const OpenVoxel& voxel : voxels) open.push_back({voxel.order(), &voxel});
    }
    std::ranges::sort(open, [](const Ordered& a, const Ordered& b) {
      return a.order[0] != b.order[0] ? a.order[0] < b.order[0] : a.order[1] < b.order[1];
    });
    Use rest = prototype;
    for (auto first = open.begin(); first != open.end();) {
      Voxel sums = first->voxel->sums;
      auto next = std::next(first);
      for (; next != open.end() && next->order[0] == first->order[0] && next->order[1] == first->order[1]; ++next) {
        sums.reference += next->voxel->sums.reference;
        sums.estimate += next->voxel->sums.estimate;
      }
      rest.voxel(first->voxel->phase, frame_.voxels().index(first->voxel->key), sums);
      first = next;
    }
    used.push_back(std::move(rest));
  }

  BothSides<const IndexedMap*> maps_;
  const PhasedFrame& frame_;
  const Source& source_;
  std::int32_t m_;
  std::int32_t edge_;  ///< of the places of a cell: its parts, and before them where windows begin that end in it
  std::vector<AxisVoxel> voxel_on_axis_;
};

}  // namespace cmap
