#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cmap {

/// Type of a number in a file.
enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t scalar_bytes(ScalarType type);
bool is_floating(ScalarType type);
std::string_view scalar_name(ScalarType type);
/// Smallest and largest value of an integer type.
double scalar_min(ScalarType type);
double scalar_max(ScalarType type);
/// By PLY's names, old ("uchar") and new ("uint8").
std::optional<ScalarType> scalar_from_ply_name(std::string_view name);
/// By PCD's TYPE (I, U, F) and SIZE in bytes.
std::optional<ScalarType> scalar_from_pcd(char kind, std::uint64_t bytes);

/// Calls f with a value of the C++ type that `type` stands for.
template <class F>
decltype(auto) visit_scalar(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::kInt8:
      return f(std::int8_t{});
    case ScalarType::kUint8:
      return f(std::uint8_t{});
    case ScalarType::kInt16:
      return f(std::int16_t{});
    case ScalarType::kUint16:
      return f(std::uint16_t{});
    case ScalarType::kInt32:
      return f(std::int32_t{});
    case ScalarType::kUint32:
      return f(std::uint32_t{});
    case ScalarType::kInt64:
      return f(std::int64_t{});
    case ScalarType::kUint64:
      return f(std::uint64_t{});
    case ScalarType::kFloat32:
      return f(float{});
    case ScalarType::kFloat64:
      break;
  }
  return f(double{});
}

}  // namespace cmap
