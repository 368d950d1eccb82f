#include "phase_fold.hpp"

#include <tuple>

namespace cmap {
namespace {

/// The runs of the first cell, which are taken off.
std::span<const CellRun> take_cell(std::span<const CellRun>& runs, const VoxelKey& cell) {
  const auto other = std::ranges::find_if(runs, [&](const CellRun& run) { return run.cell != cell; });
  const auto n = static_cast<std::size_t>(other - runs.begin());
  const std::span<const CellRun> taken = runs.first(n);
  runs = runs.subspan(n);
  return taken;
}

auto in_order(const VoxelKey& key) { return std::tie(key.x, key.y, key.z); }

}  // namespace

std::vector<PairedCell> paired_cells(std::span<const CellRun> reference, std::span<const CellRun> estimate) {
  std::vector<PairedCell> cells;
  while (!reference.empty() || !estimate.empty()) {
    const bool of_estimate =
        reference.empty() || (!estimate.empty() && in_order(estimate.front().cell) < in_order(reference.front().cell));
    const VoxelKey cell = of_estimate ? estimate.front().cell : reference.front().cell;
    PairedCell& paired = cells.emplace_back(PairedCell{cell, {}});
    paired.runs.reference = take_cell(reference, cell);
    paired.runs.estimate = take_cell(estimate, cell);
  }
  return cells;
}

}  // namespace cmap
