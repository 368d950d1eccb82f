#include "point_runs.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace cmap {
namespace {

constexpr std::size_t kRunSlots = 4096;  // whose values stay in the first caches
constexpr std::size_t kTaskSlots = 1 << 16;

/// The band of a distance: thresholds mean what was typed (spatial/threshold.hpp). It is compared with all of them:
/// which is the last one below cannot be foretold.
std::uint32_t band_of(double distance_m, std::span<const double> upper_m, const NearestPairs& pairs, std::size_t slot,
                      double most_rounding_m) {
  std::size_t band = 0;
  for (const double upper : upper_m) band += distance_m > upper ? 1 : 0;
  while (band > 0 && distance_m <= upper_m[band - 1] + most_rounding_m &&
         distance_m <= upper_m[band - 1] + pairs.rounding_m(slot)) {
    --band;
  }
  return static_cast<std::uint32_t>(band);
}

/// Several numbers at a time.
Eigen::Map<Eigen::ArrayXd> first(std::vector<double>& values, std::size_t n) {
  return {values.data(), static_cast<Eigen::Index>(n)};
}

}  // namespace

std::vector<SlotRun> slot_runs(std::size_t n, std::span<const std::uint32_t> part_of_slot) {
  std::vector<SlotRun> runs;
  for (std::size_t slot = 0; slot < n;) {
    const std::size_t chunk_end = std::min(n, (slot / kRunSlots + 1) * kRunSlots);
    const std::uint32_t part = part_of_slot.empty() ? 0 : part_of_slot[slot];
    std::size_t end = part_of_slot.empty() ? chunk_end : slot + 1;
    while (end < chunk_end && part_of_slot[end] == part) ++end;
    runs.push_back({part, slot, end});
    slot = end;
  }
  std::ranges::stable_sort(runs, {}, &SlotRun::part);
  return runs;
}

std::vector<std::span<const SlotRun>> run_tasks(std::span<const SlotRun> runs) {
  std::vector<std::span<const SlotRun>> tasks;
  std::size_t begin = 0, n_slots = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    n_slots += runs[i].end - runs[i].begin;
    if (n_slots < kTaskSlots && i + 1 < runs.size()) continue;
    tasks.push_back(runs.subspan(begin, i + 1 - begin));
    begin = i + 1;
    n_slots = 0;
  }
  return tasks;
}

RunReader::RunReader(const MetricInputs& inputs, Side side, bool with_colors)
    : inputs_(inputs),
      side_(side),
      with_colors_(with_colors && inputs.pair != nullptr && inputs.pair->has_color()),
      distance_m_(kRunSlots),
      color_distance_(kRunSlots),
      banded_distance_m_(kRunSlots),
      banded_sq_dist_(kRunSlots),
      band_(kRunSlots),
      band_begin_(inputs.settings.bands.size() + 1) {}

PointRun RunReader::read(const SlotRun& slots) {
  PointRun run{inputs_, side_, slots.begin, slots.end - slots.begin};
  if (inputs_.pair == nullptr) return run;
  read_distances(run);
  if (with_colors_) read_colors(run);
  return run;
}

void RunReader::read_distances(PointRun& run) {
  const NearestPairs pairs = inputs_.pairs(side_);
  const std::span<const double> upper_m = inputs_.settings.bands.upper_m();
  const double most_rounding_m = pairs.most_rounding_m();
  run.sq_dist = std::span(pairs.nearest.sq_dist).subspan(run.begin, run.size);
  std::ranges::copy(run.sq_dist, distance_m_.begin());
  first(distance_m_, run.size) = first(distance_m_, run.size).sqrt();
  std::ranges::fill(band_begin_, 0);
  for (std::size_t i = 0; i < run.size; ++i) {
    band_[i] = band_of(distance_m_[i], upper_m, pairs, run.begin + i, most_rounding_m);
    ++band_begin_[band_[i] + std::size_t{1}];
  }
  for (std::size_t band = 1; band < band_begin_.size(); ++band) band_begin_[band] += band_begin_[band - 1];
  std::vector<std::size_t> next = band_begin_;
  for (std::size_t i = 0; i < run.size; ++i) {
    const std::size_t place = next[band_[i]]++;
    banded_distance_m_[place] = distance_m_[i];
    banded_sq_dist_[place] = run.sq_dist[i];
  }
  run.distance_m = std::span(distance_m_).first(run.size);
  run.band_begin = band_begin_;
  run.banded_distance_m = std::span(banded_distance_m_).first(run.size);
  run.banded_sq_dist = std::span(banded_sq_dist_).first(run.size);
}

void RunReader::read_colors(PointRun& run) {
  const NearestPairs pairs = inputs_.pairs(side_);
  for (std::size_t i = 0; i < run.size; ++i) {
    const std::size_t slot = run.begin + i;
    color_distance_[i] = (pairs.from_color(slot) - pairs.to_color(slot)).squaredNorm();
  }
  first(color_distance_, run.size) = first(color_distance_, run.size).sqrt() / 255.0;
  run.color_distance = std::span(color_distance_).first(run.size);
}

}  // namespace cmap
