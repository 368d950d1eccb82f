#include "loops/ring_descriptor.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace cmap {
namespace {

using Spectrum = std::vector<std::complex<float>>;

std::vector<float> column_of(const Sinogram& values, Eigen::Index column) {
  std::vector<float> result(static_cast<std::size_t>(values.rows()));
  for (Eigen::Index i = 0; i < values.rows(); ++i) result[static_cast<std::size_t>(i)] = values(i, column);
  return result;
}

}  // namespace

Sinogram radon(const BirdsEye& view) {
  const double diagonal = std::numbers::sqrt2 * view.side + 2.0;
  const auto columns = static_cast<Eigen::Index>(std::bit_ceil(static_cast<unsigned>(diagonal)));
  Sinogram sums = Sinogram::Zero(kRingAngles, columns);
  for (Eigen::Index a = 0; a < kRingAngles; ++a) {
    const double angle = std::numbers::pi * static_cast<double>(a) / kRingAngles;
    const Eigen::Vector2d normal = Eigen::Vector2d(std::cos(angle), std::sin(angle)) / view.cell_m;
    for (const BirdsEye::Cell& cell : view.cells) {
      const double offset = normal.dot(cell.center.cast<double>()) + static_cast<double>(columns / 2);
      const auto low = static_cast<Eigen::Index>(std::floor(offset));
      const auto share = static_cast<float>(offset - static_cast<double>(low));
      sums(a, low) += (1.0F - share) * cell.value;
      sums(a, low + 1) += share * cell.value;
    }
  }
  return sums;
}

Sinogram ring_of(const Sinogram& sinogram) {
  Eigen::FFT<float> fft;
  Sinogram ring(sinogram.rows(), kRingFrequencies);
  std::vector<float> row(static_cast<std::size_t>(sinogram.cols()));
  Spectrum spectrum;
  for (Eigen::Index a = 0; a < sinogram.rows(); ++a) {
    for (Eigen::Index r = 0; r < sinogram.cols(); ++r) row[static_cast<std::size_t>(r)] = sinogram(a, r);
    fft.fwd(spectrum, row);
    for (Eigen::Index f = 0; f < kRingFrequencies; ++f) {
      ring(a, f) = std::sqrt(std::abs(spectrum[static_cast<std::size_t>(f) + 1]));
    }
  }
  ring.rowwise() -= ring.colwise().mean().eval();
  const float norm = ring.norm();
  if (norm > 0.0F) ring /= norm;
  return ring;
}

RingDescriptor ring_descriptor(const BirdsEye& view) {
  Eigen::FFT<float> fft;
  const Sinogram ring = ring_of(radon(view));
  RingDescriptor result;
  result.spectrum.resize(kRingFrequencies, kRingAngles / 2 + 1);
  Spectrum spectrum;
  for (Eigen::Index f = 0; f < kRingFrequencies; ++f) {
    fft.fwd(spectrum, column_of(ring, f));
    for (Eigen::Index k = 0; k <= kRingAngles / 2; ++k) result.spectrum(f, k) = spectrum[static_cast<std::size_t>(k)];
  }
  return result;
}

RingMatch best_turn(const RingDescriptor& source, const RingDescriptor& target) {
  // sum over f, a of source(a - shift, f) target(a, f) for every shift, by the theorem of correlation.
  Spectrum product(kRingAngles);
  for (Eigen::Index k = 0; k <= kRingAngles / 2; ++k) {
    const std::complex<float> sum = source.spectrum.col(k).dot(target.spectrum.col(k));  // conj(source) target
    product[static_cast<std::size_t>(k)] = sum;
    if (k > 0) product[static_cast<std::size_t>(kRingAngles - k)] = std::conj(sum);
  }
  Eigen::FFT<float> fft;
  Spectrum correlation;
  fft.inv(correlation, product);
  RingMatch best{-1.0, 0.0};
  for (int shift = 0; shift < kRingAngles; ++shift) {
    const auto similarity = static_cast<double>(correlation[static_cast<std::size_t>(shift)].real());
    if (similarity > best.similarity) best = {similarity, std::numbers::pi * shift / kRingAngles};
  }
  return best;
}

}  // namespace cmap
