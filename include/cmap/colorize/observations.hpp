#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// A point's color in one image, as it lies there.
struct Observation {
  float weight = 0.0f;
  std::uint32_t image = 0;  ///< place in the list of images
  Rgb8 color{};
};

/// The best observations of each point: however many images there are, at most `most` of a point are kept, those of the
/// largest weights (of equal ones the first). 12 bytes each. Different points may be added to at the same time, images
/// one after the other.
class Observations {
 public:
  Observations(std::size_t n_points, std::size_t most)
      : most_(most), kept_(n_points * most), counts_(n_points, 0), seen_(n_points, 0) {}

  void add(std::size_t point, const Observation& seen);

  std::span<const Observation> of(std::size_t point) const { return {kept_.data() + point * most_, counts_[point]}; }
  /// Views of the point, those that are not kept too.
  std::uint32_t n_seen(std::size_t point) const { return seen_[point]; }
  std::size_t n_points() const { return counts_.size(); }

 private:
  std::size_t most_;
  Array<Observation> kept_;
  Array<std::uint8_t> counts_;
  Array<std::uint32_t> seen_;
};

}  // namespace cmap
