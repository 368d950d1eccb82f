#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Positions of float files: kept exactly as they come, in the array that becomes the cloud's.
class FloatPositions {
 public:
  using Real = float;
  explicit FloatPositions(std::size_t max_points) : positions_(max_points) {}

  /// Memory for n more points (the caller stays below max_points), of which keep() then says how many stay.
  float* room(std::size_t) { return positions_.data()->data() + 3 * kept_; }
  void keep(std::size_t n) { kept_ += n; }
  std::size_t size() const { return kept_; }
  /// Drops the points exactly at 0 0 0; says of each which stays.
  Array<std::uint8_t> drop_zeros();
  /// At most n of the positions, evenly spread.
  std::vector<Eigen::Vector3d> sample(std::size_t n) const;
  /// Positions as offsets from the origin.
  Array<Eigen::Vector3f> take(const Eigen::Vector3d& origin);

 private:
  Array<Eigen::Vector3f> positions_;
  std::size_t kept_ = 0;
};

/// Positions in double until the bounds, and so the origin, are known. Chunks are freed as they are converted, so that
/// the memory never holds much more than the doubles.
class DoublePositions {
 public:
  using Real = double;
  explicit DoublePositions(std::size_t max_points);

  double* room(std::size_t n);
  void keep(std::size_t n) { chunks_.back().kept += n; }
  std::size_t size() const;
  Array<std::uint8_t> drop_zeros();
  std::vector<Eigen::Vector3d> sample(std::size_t n) const;
  Array<Eigen::Vector3f> take(const Eigen::Vector3d& origin);

 private:
  struct Chunk {
    Array<Eigen::Vector3d> positions;
    std::size_t kept = 0;
  };
  std::size_t chunk_points_;
  std::vector<Chunk> chunks_;
};

/// Gives memory back where less than half of it is used.
template <class T>
void trim(Array<T>& values, std::size_t size) {
  values.resize(size);
  if (2 * size < values.capacity()) values.shrink_to_fit();
}

}  // namespace cmap
