#include "loops/keyframe_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap {
namespace {

constexpr double kMostDeviation = 1e-3;

const char* fault_of(const Keyframe& keyframe) {
  if (!std::isfinite(keyframe.time_s)) return "its time is not finite";
  if (!keyframe.T_world_body.matrix().allFinite()) return "its pose is not finite";
  if (deviation_from_rotation(keyframe.T_world_body.linear()) > kMostDeviation) return "its pose is no rigid motion";
  const auto& points = keyframe.points_body;
  const bool are_finite = std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); });
  return are_finite ? nullptr : "a point of it is not finite";
}

}  // namespace

void check_keyframes(std::span<const Keyframe> keyframes) {
  parallel_chunks(keyframes.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const char* const fault = fault_of(keyframes[i])) {
        throw std::invalid_argument(fmt::format("keyframe {}: {}", i, fault));
      }
      if (i > 0 && !(keyframes[i].time_s > keyframes[i - 1].time_s)) {
        throw std::invalid_argument(fmt::format("keyframe {}: its time does not increase", i));
      }
    }
  });
}

}  // namespace cmap
