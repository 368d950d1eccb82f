#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/sim/predictions.hpp"

namespace cmap {

std::vector<SessionRange> cut_sessions(std::size_t frames, int length, int overlap) {
  if (overlap < 0 || length <= overlap) {
    throw UsageError(fmt::format("session_overlap {} must be at least 0 and below session_length {}", overlap, length));
  }
  const auto full = static_cast<std::size_t>(length), step = static_cast<std::size_t>(length - overlap);
  std::vector<SessionRange> sessions;
  for (std::size_t first = 0; first < frames; first += step) {
    sessions.push_back({first, std::min(full, frames - first)});
    if (first + full >= frames) break;
  }
  return sessions;
}

CameraModel network_camera(const CameraModel& camera, int width_px) {
  constexpr int kPatch = 14;
  if (width_px <= 0 || width_px % kPatch != 0) {
    throw UsageError(fmt::format("width_px {} is not a positive multiple of {}", width_px, kPatch));
  }
  // nearbyint rounds half to even, as Python's round does.
  const double patches = static_cast<double>(camera.height) * width_px / camera.width / kPatch;
  const int height = kPatch * std::max(1, static_cast<int>(std::nearbyint(patches)));
  CameraModel network;
  network.width = width_px;
  network.height = std::min(height, width_px);
  network.fx = camera.fx * width_px / camera.width;
  network.fy = camera.fy * height / camera.height;
  network.cx = 0.5 * network.width;
  network.cy = 0.5 * network.height;
  return network;
}

}  // namespace cmap
