#pragma once

// Sixteen float lanes in four SSE2 registers.

#include <emmintrin.h>

#include <cstdint>

namespace cmap::sse2 {

struct Mask16 {
  __m128 part[4];
};
struct Float16 {
  __m128 part[4];
};

inline Mask16 operator&(const Mask16& a, const Mask16& b) {
  Mask16 r;
  for (int i = 0; i < 4; ++i) r.part[i] = _mm_and_ps(a.part[i], b.part[i]);
  return r;
}
inline std::uint32_t bits(const Mask16& m) {
  std::uint32_t b = 0;
  for (int i = 0; i < 4; ++i) b |= static_cast<std::uint32_t>(_mm_movemask_ps(m.part[i])) << (4 * i);
  return b;
}
inline Mask16 mask_from_bits(std::uint32_t b) {
  Mask16 r;
  const __m128i select_bit = _mm_setr_epi32(1, 2, 4, 8);
  for (int i = 0; i < 4; ++i) {
    const __m128i quad = _mm_set1_epi32(static_cast<int>((b >> (4 * i)) & 15u));
    r.part[i] = _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(quad, select_bit), select_bit));
  }
  return r;
}

#define CMAP_LANES_BINARY(Result, name, intrinsic)                           \
  inline Result name(const Float16& a, const Float16& b) {                   \
    Result r;                                                                \
    for (int i = 0; i < 4; ++i) r.part[i] = intrinsic(a.part[i], b.part[i]); \
    return r;                                                                \
  }
CMAP_LANES_BINARY(Float16, operator+, _mm_add_ps)
CMAP_LANES_BINARY(Float16, operator-, _mm_sub_ps)
CMAP_LANES_BINARY(Float16, operator*, _mm_mul_ps)
CMAP_LANES_BINARY(Float16, min, _mm_min_ps)
CMAP_LANES_BINARY(Float16, max, _mm_max_ps)
CMAP_LANES_BINARY(Mask16, less, _mm_cmplt_ps)
CMAP_LANES_BINARY(Mask16, less_equal, _mm_cmple_ps)
CMAP_LANES_BINARY(Mask16, equal, _mm_cmpeq_ps)
#undef CMAP_LANES_BINARY

inline Float16 multiply_add(const Float16& a, const Float16& b, const Float16& c) { return a * b + c; }
inline Float16 load(const float* p) {
  return {{_mm_load_ps(p), _mm_load_ps(p + 4), _mm_load_ps(p + 8), _mm_load_ps(p + 12)}};
}
inline void store(float* p, const Float16& a) {
  for (int i = 0; i < 4; ++i) _mm_store_ps(p + 4 * i, a.part[i]);
}
inline Float16 broadcast(float v) {
  const __m128 x = _mm_set1_ps(v);
  return {{x, x, x, x}};
}
inline Float16 select(const Mask16& m, const Float16& a, const Float16& b) {
  Float16 r;
  for (int i = 0; i < 4; ++i) {
    r.part[i] = _mm_or_ps(_mm_and_ps(m.part[i], a.part[i]), _mm_andnot_ps(m.part[i], b.part[i]));
  }
  return r;
}
inline float lowest(const Float16& a) {
  __m128 v = _mm_min_ps(_mm_min_ps(a.part[0], a.part[1]), _mm_min_ps(a.part[2], a.part[3]));
  v = _mm_min_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_min_ss(v, _mm_shuffle_ps(v, v, 1)));
}
inline float highest(const Float16& a) {
  __m128 v = _mm_max_ps(_mm_max_ps(a.part[0], a.part[1]), _mm_max_ps(a.part[2], a.part[3]));
  v = _mm_max_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_max_ss(v, _mm_shuffle_ps(v, v, 1)));
}

}  // namespace cmap::sse2
