#include "cmap/metrics/color_gaussians.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "cmap/core/exact_sum.hpp"
#include "color_distances.hpp"

namespace cmap {
namespace {

/// What the voxels of one task come to.
struct ColorVoxels {
  explicit ColorVoxels(std::size_t n_phases) : sums(n_phases), counts(n_phases) {}

  std::vector<ColoredVoxel> voxels;
  std::vector<ReferenceColors> sample;
  std::vector<double> of_halves;
  std::vector<ExactSum> sums;  ///< by phase
  std::vector<std::uint64_t> counts;

  void take(const ColorVoxels& other) {
    std::ranges::copy(other.voxels, std::back_inserter(voxels));
    std::ranges::copy(other.of_halves, std::back_inserter(of_halves));
    for (std::size_t phase = 0; phase < sums.size(); ++phase) {
      sums[phase] += other.sums[phase];
      counts[phase] += other.counts[phase];
    }
  }
};

/// Takes the voxels of one task.
template <class Word>
class ColorUse {
 public:
  ColorUse(const PhasedFrame& frame, const PhaseOptions& options, double step)
      : voxels_(&frame.voxels()),
        min_points_(std::max<std::uint64_t>(options.min_points, 2)),
        step_(step),
        with_sample_(options.halves),
        distances_(step),
        found_(static_cast<std::size_t>(frame.n_phases())) {}

  void voxel(int phase, const VoxelKey& key, const PhaseVoxel<ColorSums<Word>>& colors) {
    const std::uint64_t n_reference = colors.reference.n(), n_estimate = colors.estimate.n();
    if (n_reference < min_points_ || n_estimate < min_points_ || !fits(n_reference) || !fits(n_estimate)) return;
    if (phase == 0) {
      const VoxelIndex index = voxels_->index(key);
      found_.voxels.push_back({index, NAN, n_reference, n_estimate});
      if (with_sample_) {
        found_.sample.push_back({index, 0, n_estimate, WideColorSums(colors.reference).gaussian(step_)});
      }
    }
    distances_.add(phase, colors.reference, colors.estimate, deliver());
  }
  void halves(const VoxelKey&, const ColorSums<Word>& one, const ColorSums<Word>& other) {
    if (one.n() < min_points_ || other.n() < min_points_ || !fits(one.n()) || !fits(other.n())) return;
    distances_.add(kOfHalves, one, other, deliver());
  }

  /// After the last voxel.
  ColorVoxels& finish() {
    distances_.flush(deliver());
    return found_;
  }
  /// Whether a voxel had more points than words of this size can sum; it was left out.
  bool is_overfull() const { return is_overfull_; }

 private:
  static constexpr int kOfHalves = -1;

  bool fits(std::uint64_t n) {
    const bool does = sizeof(Word) > 4 || n <= kMostNarrow;
    is_overfull_ = is_overfull_ || !does;
    return does;
  }

  auto deliver() {
    return [this](int phase, double distance) {
      if (phase == kOfHalves) return found_.of_halves.push_back(distance);
      found_.sums[static_cast<std::size_t>(phase)].add(distance);
      ++found_.counts[static_cast<std::size_t>(phase)];
      if (phase == 0) found_.voxels[n_delivered_++].distance = distance;
    };
  }

  const VoxelFrame* voxels_;
  std::uint64_t min_points_;
  double step_;
  bool with_sample_;
  ColorDistances<Word> distances_;
  ColorVoxels found_;
  std::size_t n_delivered_ = 0;  ///< to `voxels`
  bool is_overfull_ = false;
};

/// The first corner of the voxels that the tasks have taken.
VoxelIndex first_index(std::span<const ColorVoxels> used) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  VoxelIndex first{kMost, kMost, kMost};
  for (const ColorVoxels& use : used) {
    for (const ColoredVoxel& voxel : use.voxels) {
      for (std::size_t axis = 0; axis < 3; ++axis) first[axis] = std::min(first[axis], voxel.index[axis]);
    }
  }
  return first;
}

/// At most 20,000 of the tasks' samples: those with the lowest hashes of where they lie among the others, which become
/// their seeds; ordered by these. The rest is dropped.
std::vector<ReferenceColors> take_sample(std::span<ColorVoxels> used) {
  constexpr std::size_t kMost = 20'000;
  constexpr std::uint64_t kSeed = 19;
  const VoxelIndex first = first_index(used);
  std::vector<ReferenceColors*> all;
  for (ColorVoxels& use : used) {
    for (ReferenceColors& voxel : use.sample) {
      voxel.seed = kSeed;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        voxel.seed = random_hash(static_cast<std::uint64_t>(voxel.index[axis] - first[axis]), voxel.seed);
      }
      all.push_back(&voxel);
    }
  }
  const auto seed = [](const ReferenceColors* voxel) { return voxel->seed; };
  if (all.size() > kMost) {
    std::ranges::nth_element(all, all.begin() + kMost, {}, seed);
    all.resize(kMost);
  }
  std::ranges::sort(all, {}, seed);
  std::vector<ReferenceColors> sample;
  for (const ReferenceColors* voxel : all) sample.push_back(*voxel);
  for (ColorVoxels& use : used) use.sample = {};
  return sample;
}

/// The voxels of all tasks; none where one has more points than words of this size can sum.
template <class Word>
std::optional<std::vector<ColorVoxels>> color_voxels(const MapPair& pair, const PhasedFrame& frame,
                                                     const PhaseOptions& options) {
  using Source = ColorSource<Word>;
  using Use = ColorUse<Word>;
  const Source source(maps_of(pair), options.halves);
  const Use none(frame, options, source.step);
  std::vector<Use> used = PhaseFold<Source, Use>(maps_of(pair), frame, source).run(none);
  std::vector<ColorVoxels> found;
  for (Use& use : used) {
    if (use.is_overfull()) return std::nullopt;
    found.push_back(std::move(use.finish()));
  }
  return found;
}

std::vector<ColorVoxels> color_voxels_of(const MapPair& pair, const PhasedFrame& frame, const PhaseOptions& options) {
  if (has_8_bit_colors(maps_of(pair))) {
    if (auto narrow = color_voxels<std::uint32_t>(pair, frame, options)) return *std::move(narrow);
  }
  return *color_voxels<std::uint64_t>(pair, frame, options);
}

}  // namespace

ColorWasserstein color_wasserstein(const MapPair& pair, const PhaseOptions& options) {
  if (!pair.has_color()) throw std::invalid_argument("color_wasserstein: both maps need colors");
  const PhasedFrame frame(united(pair.reference.index.bounds(), pair.estimate.index.bounds()), options.voxel_m,
                          options.parts_per_axis);
  const auto n_phases = static_cast<std::size_t>(frame.n_phases());
  std::vector<ColorVoxels> used = color_voxels_of(pair, frame, options);
  ColorWasserstein found;
  found.sample = take_sample(used);
  ColorVoxels all(n_phases);
  for (const ColorVoxels& use : used) all.take(use);
  found.voxels = std::move(all.voxels);
  found.of_halves = std::move(all.of_halves);
  for (std::size_t phase = 0; phase < n_phases; ++phase) {
    found.phase_means.push_back(all.sums[phase].value() / static_cast<double>(all.counts[phase]));
  }
  return found;
}

}  // namespace cmap
