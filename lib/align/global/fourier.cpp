#include "global/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cmap {

Fourier2d::Fourier2d(std::size_t side) : side_(side), roots_(side / 2), reversed_(side, 0) {
  if (side < 2 || (side & (side - 1)) != 0) throw std::invalid_argument("a side that is a power of two is needed");
  for (std::size_t k = 0; k < side / 2; ++k) {
    const double angle = -2.0 * M_PI * static_cast<double>(k) / static_cast<double>(side);
    roots_[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  for (std::size_t i = 1; i < side; ++i) reversed_[i] = reversed_[i / 2] / 2 + (i % 2 == 1 ? side / 2 : 0);
}

void Fourier2d::transform(Grid& grid) const {
  transform_columns(grid, false);
  transpose(grid);
  transform_columns(grid, false);
}

void Fourier2d::inverse(Grid& grid) const {
  transform_columns(grid, true);
  transpose(grid);
  transform_columns(grid, true);
}

void Fourier2d::transform_columns(Grid& grid, bool is_inverse) const {
  const std::size_t n = side_;
  for (std::size_t i = 0; i < n; ++i) {
    if (i < reversed_[i]) std::swap_ranges(&grid[i * n], &grid[i * n] + n, &grid[reversed_[i] * n]);
  }
  for (std::size_t half = 1; half < n; half *= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      const std::complex<float> root = roots_[k * (n / 2 / half)];
      const float re = root.real(), im = is_inverse ? -root.imag() : root.imag();
      for (std::size_t first = k; first < n; first += 2 * half) {
        // As floats: the complex product of the standard looks after infinities, ten times slower.
        float* a = reinterpret_cast<float*>(&grid[first * n]);
        float* b = reinterpret_cast<float*>(&grid[(first + half) * n]);
        for (std::size_t i = 0; i < 2 * n; i += 2) {
          const float b_re = b[i] * re - b[i + 1] * im, b_im = b[i] * im + b[i + 1] * re;
          b[i] = a[i] - b_re;
          b[i + 1] = a[i + 1] - b_im;
          a[i] += b_re;
          a[i + 1] += b_im;
        }
      }
    }
  }
}

void Fourier2d::transpose(Grid& grid) const {
  constexpr std::size_t kTile = 16;
  for (std::size_t r0 = 0; r0 < side_; r0 += kTile) {
    for (std::size_t c0 = r0; c0 < side_; c0 += kTile) {
      for (std::size_t r = r0; r < std::min(side_, r0 + kTile); ++r) {
        for (std::size_t c = std::max(c0, r + 1); c < std::min(side_, c0 + kTile); ++c) {
          std::swap(grid[r * side_ + c], grid[c * side_ + r]);
        }
      }
    }
  }
}

}  // namespace cmap
