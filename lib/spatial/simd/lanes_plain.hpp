#pragma once

// Sixteen float lanes in plain C++: the reference that the instruction-set versions must equal bit for bit.

#include <cstdint>

namespace cmap::plain {

struct Mask16 {
  std::uint32_t bits;
};
inline Mask16 operator&(Mask16 a, Mask16 b) { return {a.bits & b.bits}; }
inline std::uint32_t bits(Mask16 m) { return m.bits; }
inline Mask16 mask_from_bits(std::uint32_t b) { return {b}; }

struct Float16 {
  float lane[16];
};

template <class Op>
inline Float16 each_lane(const Float16& a, const Float16& b, Op op) {
  Float16 result;
  for (int i = 0; i < 16; ++i) result.lane[i] = op(a.lane[i], b.lane[i]);
  return result;
}
template <class Op>
inline Mask16 each_lane_mask(const Float16& a, const Float16& b, Op op) {
  std::uint32_t mask = 0;
  for (int i = 0; i < 16; ++i) mask |= static_cast<std::uint32_t>(op(a.lane[i], b.lane[i])) << i;
  return {mask};
}

inline Float16 load(const float* p) {
  Float16 result;
  for (int i = 0; i < 16; ++i) result.lane[i] = p[i];
  return result;
}
inline void store(float* p, const Float16& a) {
  for (int i = 0; i < 16; ++i) p[i] = a.lane[i];
}
inline Float16 broadcast(float v) {
  Float16 result;
  for (int i = 0; i < 16; ++i) result.lane[i] = v;
  return result;
}
inline Float16 operator+(const Float16& a, const Float16& b) {
  return each_lane(a, b, [](float x, float y) { return x + y; });
}
inline Float16 operator-(const Float16& a, const Float16& b) {
  return each_lane(a, b, [](float x, float y) { return x - y; });
}
inline Float16 operator*(const Float16& a, const Float16& b) {
  return each_lane(a, b, [](float x, float y) { return x * y; });
}
/// a * b + c; fused where the instruction set has it, so the last bit may differ between levels.
inline Float16 multiply_add(const Float16& a, const Float16& b, const Float16& c) { return a * b + c; }
inline Float16 min(const Float16& a, const Float16& b) {
  return each_lane(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline Float16 max(const Float16& a, const Float16& b) {
  return each_lane(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline Mask16 less(const Float16& a, const Float16& b) {
  return each_lane_mask(a, b, [](float x, float y) { return x < y; });
}
inline Mask16 less_equal(const Float16& a, const Float16& b) {
  return each_lane_mask(a, b, [](float x, float y) { return x <= y; });
}
inline Mask16 equal(const Float16& a, const Float16& b) {
  return each_lane_mask(a, b, [](float x, float y) { return x == y; });
}
/// Lanes of `a` where the mask is set, else of `b`.
inline Float16 select(Mask16 m, const Float16& a, const Float16& b) {
  Float16 result;
  for (int i = 0; i < 16; ++i) result.lane[i] = (m.bits >> i) & 1u ? a.lane[i] : b.lane[i];
  return result;
}
inline float lowest(const Float16& a) {
  float v = a.lane[0];
  for (int i = 1; i < 16; ++i) v = a.lane[i] < v ? a.lane[i] : v;
  return v;
}
inline float highest(const Float16& a) {
  float v = a.lane[0];
  for (int i = 1; i < 16; ++i) v = a.lane[i] > v ? a.lane[i] : v;
  return v;
}

}  // namespace cmap::plain
