#pragma once

// Sixteen float lanes in one AVX-512 register.

#include <immintrin.h>

#include <cstdint>

namespace cmap::avx512 {

struct Mask16 {
  __mmask16 value;
};
struct Float16 {
  __m512 value;
};

inline Mask16 operator&(Mask16 a, Mask16 b) { return {static_cast<__mmask16>(a.value & b.value)}; }
inline std::uint32_t bits(Mask16 m) { return m.value; }
inline Mask16 mask_from_bits(std::uint32_t b) { return {static_cast<__mmask16>(b)}; }

inline Float16 operator+(Float16 a, Float16 b) { return {_mm512_add_ps(a.value, b.value)}; }
inline Float16 operator-(Float16 a, Float16 b) { return {_mm512_sub_ps(a.value, b.value)}; }
inline Float16 operator*(Float16 a, Float16 b) { return {_mm512_mul_ps(a.value, b.value)}; }
inline Float16 multiply_add(Float16 a, Float16 b, Float16 c) { return {_mm512_fmadd_ps(a.value, b.value, c.value)}; }
inline Float16 min(Float16 a, Float16 b) { return {_mm512_min_ps(a.value, b.value)}; }
inline Float16 max(Float16 a, Float16 b) { return {_mm512_max_ps(a.value, b.value)}; }
inline Mask16 less(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.value, b.value, _CMP_LT_OQ)}; }
inline Mask16 less_equal(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.value, b.value, _CMP_LE_OQ)}; }
inline Mask16 equal(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.value, b.value, _CMP_EQ_OQ)}; }

inline Float16 load(const float* p) { return {_mm512_load_ps(p)}; }
inline void store(float* p, Float16 a) { _mm512_store_ps(p, a.value); }
inline Float16 broadcast(float v) { return {_mm512_set1_ps(v)}; }
inline Float16 select(Mask16 m, Float16 a, Float16 b) { return {_mm512_mask_blend_ps(m.value, b.value, a.value)}; }
inline float lowest(Float16 a) { return _mm512_reduce_min_ps(a.value); }
inline float highest(Float16 a) { return _mm512_reduce_max_ps(a.value); }

}  // namespace cmap::avx512
