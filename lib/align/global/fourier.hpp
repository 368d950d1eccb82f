#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace cmap {

/// Discrete Fourier transforms of square grids, by rows. Spectra are transposed, which products of spectra do not mind.
/// Thread-safe.
class Fourier2d {
 public:
  using Grid = std::vector<std::complex<float>>;

  explicit Fourier2d(std::size_t side) : side_(side) {}

  std::size_t side() const { return side_; }
  void transform(Grid& grid) const;
  /// Back, times side^2.
  void inverse(Grid& grid) const;

 private:
  std::size_t side_;
};

}  // namespace cmap
