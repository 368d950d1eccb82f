#include "global/fourier.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <unsupported/Eigen/FFT>

namespace cmap {
namespace {

/// Rows, and then what were columns: transform(row, row_in_place).
template <class TransformRow>
void transform_both(std::size_t side, Fourier2d::Grid& grid, TransformRow transform_row) {
  const auto n = static_cast<Eigen::Index>(side);
  Fourier2d::Grid row(side);
  for (int axis = 0; axis < 2; ++axis) {
    if (axis == 1) Eigen::Map<Eigen::MatrixXcf>(grid.data(), n, n).transposeInPlace();
    for (auto first = grid.begin(); first != grid.end(); first += n) {
      // Grids are larger than maps, so that shifts do not wrap: many rows are empty.
      if (std::all_of(first, first + n, [](const std::complex<float>& v) { return v == 0.0f; })) continue;
      std::copy_n(first, side, row.begin());
      transform_row(&*first, row.data(), n);
    }
  }
}

}  // namespace

void Fourier2d::transform(Grid& grid) const {
  Eigen::FFT<float> fft;
  transform_both(side_, grid,
                 [&](std::complex<float>* to, const std::complex<float>* row, Eigen::Index n) { fft.fwd(to, row, n); });
}

void Fourier2d::inverse(Grid& grid) const {
  Eigen::FFT<float> fft(Eigen::default_fft_impl<float>(), Eigen::FFT<float>::Unscaled);
  transform_both(side_, grid,
                 [&](std::complex<float>* to, const std::complex<float>* row, Eigen::Index n) { fft.inv(to, row, n); });
}

}  // namespace cmap
