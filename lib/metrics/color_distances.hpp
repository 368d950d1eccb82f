#pragma once

#include "color_sums.hpp"
#include "simd/kernels.hpp"

namespace cmap {

/// The distances of pairs of voxels that are given one by one: each goes, in their order, to use(tag, distance).
template <class Word>
class ColorDistances {
 public:
  explicit ColorDistances(double step) : step_(step) {}

  template <class Use>
  void add(int tag, const ColorSums<Word>& reference, const ColorSums<Word>& estimate, Use use) {
    use(tag, wasserstein_distance(reference.gaussian(step_), estimate.gaussian(step_)));
  }
  template <class Use>
  void flush(Use) {}

 private:
  double step_;
};

/// Of narrow words: as many at once as a kernel takes.
template <>
class ColorDistances<std::uint32_t> {
 public:
  explicit ColorDistances(double step) : step_(step) {}

  template <class Use>
  void add(int tag, const NarrowColorSums& reference, const NarrowColorSums& estimate, Use use) {
    for (std::size_t i = 0; i < ColorPairLanes::kWords; ++i) {
      lanes_.reference[i][n_] = reference.words()[i];
      lanes_.estimate[i][n_] = estimate.words()[i];
    }
    tags_[n_++] = tag;
    if (n_ == ColorPairLanes::kLanes) flush(use);
  }
  template <class Use>
  void flush(Use use) {
    std::array<double, ColorPairLanes::kLanes> distances;
    metric_kernels().color_distances(lanes_, distances.data());
    for (std::size_t i = 0; i < n_; ++i) use(tags_[i], step_ * distances[i]);
    n_ = 0;
  }

 private:
  double step_;
  std::size_t n_ = 0;
  ColorPairLanes lanes_{};
  std::array<int, ColorPairLanes::kLanes> tags_{};
};

}  // namespace cmap
