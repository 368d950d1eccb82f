#include "cmap/sim/random_stream.hpp"

#include <cmath>
#include <numbers>

namespace cmap {
namespace {

/// The finalizer of SplitMix64: every bit of the input changes about half of the output.
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t purpose, std::uint64_t item)
    : state_(mixed(mixed(mixed(seed + kGolden) + purpose + kGolden) + item + kGolden)) {}

std::uint64_t RandomStream::bits() {
  state_ += kGolden;
  return mixed(state_);
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double RandomStream::normal() {
  const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace cmap
