#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace cmap {

/// Discrete Fourier transforms of square grids, by rows; the side is a power of two. Spectra are transposed, which
/// products of spectra do not mind. Thread-safe.
class Fourier2d {
 public:
  using Grid = std::vector<std::complex<float>>;

  explicit Fourier2d(std::size_t side);

  std::size_t side() const { return side_; }
  void transform(Grid& grid) const;
  /// Back, times side^2.
  void inverse(Grid& grid) const;

 private:
  /// Of all columns at once.
  void transform_columns(Grid& grid, bool is_inverse) const;
  void transpose(Grid& grid) const;

  std::size_t side_;
  std::vector<std::complex<float>> roots_;  ///< exp(-2 pi i k / side), k < side / 2
  std::vector<std::size_t> reversed_;
};

}  // namespace cmap
