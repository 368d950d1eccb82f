#pragma once

#include <cstdint>

namespace cmap {

/// Random numbers of one item (a beam, a pixel, a sample) of one purpose: items can be drawn in any order and by any
/// thread, and give the same numbers on every machine. SplitMix64 (Steele, Lea, Flood 2014) from a start that is a hash
/// of the three numbers. Not thread-safe; make one per item.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t purpose, std::uint64_t item = 0);

  std::uint64_t bits();
  /// In [0, 1), with 53 random bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Mean 0, standard deviation 1 (Box and Muller).
  double normal();

 private:
  std::uint64_t state_;
};

/// Purposes of the simulator's streams.
enum RandomPurpose : std::uint64_t {
  kRandomSway = 1,
  kRandomImuWhite,
  kRandomImuBias,
  kRandomBeam,
  kRandomSessionUnit,
  kRandomSessionOutlier,
  kRandomSessionPose,
  kRandomSessionIntrinsics,
  kRandomDepthField,
  kRandomDepthPixel,
  kRandomPointField,
  kRandomPointPixel,
  kRandomLioDrift,
  kRandomExposure,
  kRandomImagePixel,
};

}  // namespace cmap
