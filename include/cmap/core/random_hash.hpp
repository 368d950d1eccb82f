#pragma once

#include <cstdint>

namespace cmap {

/// A number that looks random and is the same everywhere: splitmix64 (Steele, Lea, Flood 2014) of a value and a seed.
inline std::uint64_t random_hash(std::uint64_t value, std::uint64_t seed) {
  std::uint64_t z = (value + 1) * 0x9e3779b97f4a7c15ull + seed * 0xd1342543de82ef95ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// One of the numbers below n, each as likely as the others to 1 in 2^32; n at most 2^32.
inline std::uint64_t random_below(std::uint64_t n, std::uint64_t value, std::uint64_t seed) {
  return ((random_hash(value, seed) >> 32) * n) >> 32;
}

}  // namespace cmap
