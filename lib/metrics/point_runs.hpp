#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cmap/metrics/metric.hpp"

namespace cmap {

/// Consecutive slots of one part of space, no more than a chunk's.
struct SlotRun {
  std::uint32_t part;
  std::size_t begin, end;
};

/// n slots as runs, ordered by part and slot; no parts given: all in part 0.
std::vector<SlotRun> slot_runs(std::size_t n, std::span<const std::uint32_t> part_of_slot);

/// Runs of enough slots for one task each.
std::vector<std::span<const SlotRun>> run_tasks(std::span<const SlotRun> runs);

/// Computes what several metrics read of a run's points. Buffers are used again; one reader a thread.
class RunReader {
 public:
  RunReader(const MetricInputs& inputs, Side side, bool with_colors);

  /// Valid until the next call.
  PointRun read(const SlotRun& run);

 private:
  void read_distances(PointRun& run);
  void read_colors(PointRun& run);

  const MetricInputs& inputs_;
  Side side_;
  bool with_colors_;
  std::vector<double> distance_m_, color_distance_, banded_distance_m_, banded_sq_dist_;
  std::vector<std::uint32_t> band_;
  std::vector<std::size_t> band_begin_;
};

}  // namespace cmap
