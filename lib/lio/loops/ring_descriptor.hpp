#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "loops/birds_eye.hpp"

namespace cmap {

/// A view's lines seen from all sides (Xu et al., "RING++: Roto-translation Invariant Gram for Global Localization",
/// T-RO 2023, with one channel): the Radon transform S(angle, offset); the magnitude of its Fourier transform along the
/// offset does not change where the view is shifted, and shifts along the angle where it turns.
/// Angles are 180 deg a / kAngles: the other half is the same mirrored, with the same magnitudes, so that a turn is
/// known but for 180 degrees.
inline constexpr int kRingAngles = 120;

/// Sums of cells along lines: row a, column r holds those with x cos + y sin = (r - columns / 2) cell_m for the angle
/// of row a; a cell's value is split between the two nearest offsets. As many columns as the power of two that holds
/// the square's diagonal.
using Sinogram = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Sinogram radon(const BirdsEye& view);

/// Magnitudes of the sinogram's Fourier transform along the offset: row a, column f the frequency f + 1 of the kept
/// ones (the constant and the upper half are left out), square roots taken so that a few strong walls do not decide,
/// each frequency's mean over the angles subtracted, and all scaled to norm 1 (zero where nothing is left).
inline constexpr int kRingFrequencies = 60;
Sinogram ring_of(const Sinogram& sinogram);

/// What is kept of a view to compare it with others.
struct RingDescriptor {
  /// Fourier transform of the ring along the angle: row f, column k = 0 .. kRingAngles / 2.
  Eigen::MatrixXcf spectrum;
};
RingDescriptor ring_descriptor(const BirdsEye& view);

/// How alike two views are, and how the source is turned to lie on the target.
struct RingMatch {
  double similarity = 0.0;  ///< normalized cross-correlation, -1 to 1
  double yaw_rad = 0.0;     ///< in [0, pi): x_target = R(yaw) x_source + shift, or yaw + pi
};
RingMatch best_turn(const RingDescriptor& source, const RingDescriptor& target);

}  // namespace cmap
