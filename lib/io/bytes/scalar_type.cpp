#include "bytes/scalar_type.hpp"

#include <array>
#include <limits>
#include <type_traits>
#include <utility>

namespace cmap {

std::size_t scalar_bytes(ScalarType type) {
  return visit_scalar(type, [](auto value) { return sizeof(value); });
}

bool is_floating(ScalarType type) { return type == ScalarType::kFloat32 || type == ScalarType::kFloat64; }

std::string_view scalar_name(ScalarType type) {
  constexpr std::array<std::string_view, 10> kNames{"int8",   "uint8", "int16",  "uint16",  "int32",
                                                    "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

double scalar_min(ScalarType type) {
  return visit_scalar(type, [](auto v) { return static_cast<double>(std::numeric_limits<decltype(v)>::lowest()); });
}

double scalar_max(ScalarType type) {
  return visit_scalar(type, [](auto v) { return static_cast<double>(std::numeric_limits<decltype(v)>::max()); });
}

std::optional<ScalarType> scalar_from_ply_name(std::string_view name) {
  using enum ScalarType;
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", kInt8},     {"int8", kInt8},       {"uchar", kUint8},    {"uint8", kUint8},    {"short", kInt16},
      {"int16", kInt16},   {"ushort", kUint16},   {"uint16", kUint16},  {"int", kInt32},      {"int32", kInt32},
      {"uint", kUint32},   {"uint32", kUint32},   {"int64", kInt64},    {"uint64", kUint64},  {"bool", kUint8},
      {"float", kFloat32}, {"float32", kFloat32}, {"double", kFloat64}, {"float64", kFloat64}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::optional<ScalarType> scalar_from_pcd(char kind, std::uint64_t bytes) {
  using enum ScalarType;
  if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) return std::nullopt;
  const int exponent = bytes == 1 ? 0 : bytes == 2 ? 1 : bytes == 4 ? 2 : 3;
  constexpr ScalarType kSigned[] = {kInt8, kInt16, kInt32, kInt64};
  constexpr ScalarType kUnsigned[] = {kUint8, kUint16, kUint32, kUint64};
  switch (kind) {
    case 'I':
      return kSigned[exponent];
    case 'U':
      return kUnsigned[exponent];
    case 'F':
      if (exponent < 2) return std::nullopt;
      return exponent == 2 ? kFloat32 : kFloat64;
    default:
      return std::nullopt;
  }
}

}  // namespace cmap
