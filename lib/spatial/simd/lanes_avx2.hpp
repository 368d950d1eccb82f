#pragma once

// Sixteen float lanes in two AVX registers.

#include <immintrin.h>

#include <cstdint>

namespace cmap::avx2 {

struct Mask16 {
  __m256 part[2];
};
struct Float16 {
  __m256 part[2];
};

inline Mask16 operator&(const Mask16& a, const Mask16& b) {
  return {{_mm256_and_ps(a.part[0], b.part[0]), _mm256_and_ps(a.part[1], b.part[1])}};
}
inline std::uint32_t bits(const Mask16& m) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(m.part[0])) |
         static_cast<std::uint32_t>(_mm256_movemask_ps(m.part[1])) << 8;
}
inline Mask16 mask_from_bits(std::uint32_t b) {
  Mask16 r;
  const __m256i select_bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  for (int i = 0; i < 2; ++i) {
    const __m256i octet = _mm256_set1_epi32(static_cast<int>((b >> (8 * i)) & 255u));
    r.part[i] = _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(octet, select_bit), select_bit));
  }
  return r;
}

inline Float16 operator+(const Float16& a, const Float16& b) {
  return {{_mm256_add_ps(a.part[0], b.part[0]), _mm256_add_ps(a.part[1], b.part[1])}};
}
inline Float16 operator-(const Float16& a, const Float16& b) {
  return {{_mm256_sub_ps(a.part[0], b.part[0]), _mm256_sub_ps(a.part[1], b.part[1])}};
}
inline Float16 operator*(const Float16& a, const Float16& b) {
  return {{_mm256_mul_ps(a.part[0], b.part[0]), _mm256_mul_ps(a.part[1], b.part[1])}};
}
inline Float16 multiply_add(const Float16& a, const Float16& b, const Float16& c) {
  return {{_mm256_fmadd_ps(a.part[0], b.part[0], c.part[0]), _mm256_fmadd_ps(a.part[1], b.part[1], c.part[1])}};
}
inline Float16 min(const Float16& a, const Float16& b) {
  return {{_mm256_min_ps(a.part[0], b.part[0]), _mm256_min_ps(a.part[1], b.part[1])}};
}
inline Float16 max(const Float16& a, const Float16& b) {
  return {{_mm256_max_ps(a.part[0], b.part[0]), _mm256_max_ps(a.part[1], b.part[1])}};
}
inline Mask16 less(const Float16& a, const Float16& b) {
  return {{_mm256_cmp_ps(a.part[0], b.part[0], _CMP_LT_OQ), _mm256_cmp_ps(a.part[1], b.part[1], _CMP_LT_OQ)}};
}
inline Mask16 less_equal(const Float16& a, const Float16& b) {
  return {{_mm256_cmp_ps(a.part[0], b.part[0], _CMP_LE_OQ), _mm256_cmp_ps(a.part[1], b.part[1], _CMP_LE_OQ)}};
}
inline Mask16 equal(const Float16& a, const Float16& b) {
  return {{_mm256_cmp_ps(a.part[0], b.part[0], _CMP_EQ_OQ), _mm256_cmp_ps(a.part[1], b.part[1], _CMP_EQ_OQ)}};
}

inline Float16 load(const float* p) { return {{_mm256_load_ps(p), _mm256_load_ps(p + 8)}}; }
inline void store(float* p, const Float16& a) {
  _mm256_store_ps(p, a.part[0]);
  _mm256_store_ps(p + 8, a.part[1]);
}
inline Float16 broadcast(float v) { return {{_mm256_set1_ps(v), _mm256_set1_ps(v)}}; }
inline Float16 select(const Mask16& m, const Float16& a, const Float16& b) {
  return {{_mm256_blendv_ps(b.part[0], a.part[0], m.part[0]), _mm256_blendv_ps(b.part[1], a.part[1], m.part[1])}};
}
inline float lowest(const Float16& a) {
  const __m256 v8 = _mm256_min_ps(a.part[0], a.part[1]);
  __m128 v = _mm_min_ps(_mm256_castps256_ps128(v8), _mm256_extractf128_ps(v8, 1));
  v = _mm_min_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_min_ss(v, _mm_shuffle_ps(v, v, 1)));
}
inline float highest(const Float16& a) {
  const __m256 v8 = _mm256_max_ps(a.part[0], a.part[1]);
  __m128 v = _mm_max_ps(_mm256_castps256_ps128(v8), _mm256_extractf128_ps(v8, 1));
  v = _mm_max_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_max_ss(v, _mm_shuffle_ps(v, v, 1)));
}

}  // namespace cmap::avx2
