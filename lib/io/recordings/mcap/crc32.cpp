#include "recordings/mcap/crc32.hpp"

#include <zlib.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace cmap {
namespace {

std::uint32_t plain_crc32(std::uint32_t before, std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

#if defined(__x86_64__)

#define CMAP_CARRY_LESS __attribute__((target("pclmul,sse4.1")))

// Gopal et al., Fast CRC Computation for Generic Polynomials Using PCLMULQDQ Instruction, Intel 2009: x^n modulo the
// polynomial, bits reversed, for the distances over which 512, 128 and 64 bits are folded.
constexpr long long kFold512Low = 0x154442bd4, kFold512High = 0x1c6e41596;
constexpr long long kFold128Low = 0x1751997d0, kFold128High = 0x0ccaa009e;
constexpr long long kFold64 = 0x163cd6124, kPolynomial = 0x1db710641, kReciprocal = 0x1f7011641;

CMAP_CARRY_LESS inline __m128i load(const std::byte* place) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(place));
}

CMAP_CARRY_LESS inline __m128i fold(__m128i value, __m128i next, __m128i factors) {
  const __m128i low = _mm_clmulepi64_si128(value, factors, 0x00);
  const __m128i high = _mm_clmulepi64_si128(value, factors, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

/// From 128 bits to 32 (Barrett's reduction).
CMAP_CARRY_LESS inline std::uint32_t reduce(__m128i value) {
  const __m128i low32 = _mm_setr_epi32(-1, 0, -1, 0);
  const __m128i factors = _mm_set_epi64x(kFold128High, kFold128Low);
  value = _mm_xor_si128(_mm_srli_si128(value, 8), _mm_clmulepi64_si128(value, factors, 0x10));
  const __m128i upper = _mm_srli_si128(value, 4);
  value = _mm_xor_si128(_mm_clmulepi64_si128(_mm_and_si128(value, low32), _mm_set_epi64x(0, kFold64), 0x00), upper);
  const __m128i barrett = _mm_set_epi64x(kReciprocal, kPolynomial);
  __m128i quotient = _mm_clmulepi64_si128(_mm_and_si128(value, low32), barrett, 0x10);
  quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low32), barrett, 0x00);
  return static_cast<std::uint32_t>(_mm_extract_epi32(_mm_xor_si128(value, quotient), 1));
}

/// Of a multiple of 16 bytes, at least 64.
CMAP_CARRY_LESS std::uint32_t folded_crc32(std::uint32_t before, const std::byte* place, std::size_t n) {
  __m128i lanes[4];
  for (int k = 0; k < 4; ++k) lanes[k] = load(place + 16 * k);
  lanes[0] = _mm_xor_si128(lanes[0], _mm_cvtsi32_si128(static_cast<int>(~before)));
  const __m128i far = _mm_set_epi64x(kFold512High, kFold512Low);
  for (place += 64, n -= 64; n >= 64; place += 64, n -= 64) {
    for (int k = 0; k < 4; ++k) lanes[k] = fold(lanes[k], load(place + 16 * k), far);
  }
  const __m128i near = _mm_set_epi64x(kFold128High, kFold128Low);
  __m128i value = lanes[0];
  for (int k = 1; k < 4; ++k) value = fold(value, lanes[k], near);
  for (; n >= 16; place += 16, n -= 16) value = fold(value, load(place), near);
  return ~reduce(value);
}

#endif

}  // namespace

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
#if defined(__x86_64__)
  static const bool is_fast = __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1");
  if (is_fast && bytes.size() >= 64) {
    const std::size_t whole = bytes.size() & ~std::size_t{15};
    before = folded_crc32(before, bytes.data(), whole);
    bytes = bytes.subspan(whole);
  }
#endif
  return plain_crc32(before, bytes);
}

}  // namespace cmap
