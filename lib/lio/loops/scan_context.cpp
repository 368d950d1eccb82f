#include "loops/scan_context.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

/// Columns scaled to norm 1; empty ones stay zero.
Eigen::MatrixXf unit_columns(const Eigen::MatrixXf& heights) {
  Eigen::MatrixXf unit = heights;
  for (Eigen::Index c = 0; c < unit.cols(); ++c) {
    const float norm = unit.col(c).norm();
    if (norm > 0.0F) unit.col(c) /= norm;
  }
  return unit;
}

}  // namespace

ScanContext scan_context(const PointCloud& points, double ground_m, double radius_m) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  ScanContext context;
  context.heights = Eigen::MatrixXf::Zero(ScanContext::kRings, ScanContext::kSectors);
  for (const Eigen::Vector3f& p : points.positions) {
    const auto x = static_cast<double>(p.x()), y = static_cast<double>(p.y());
    const double range_m = std::hypot(x, y);
    if (range_m >= radius_m) continue;
    const double azimuth = std::atan2(y, x) + (y < 0.0 ? kTurn : 0.0);
    const int ring = static_cast<int>(range_m / radius_m * ScanContext::kRings);
    const int sector = std::min(static_cast<int>(azimuth / kTurn * ScanContext::kSectors), ScanContext::kSectors - 1);
    float& height = context.heights(ring, sector);
    height = std::max(height, static_cast<float>(static_cast<double>(p.z()) - ground_m));
  }
  context.ring_key = context.heights.rowwise().mean();
  return context;
}

ScanContextMatch best_turn(const ScanContext& source, const ScanContext& target) {
  // cosines(a, b) of the source's sector a and the target's sector b.
  const Eigen::MatrixXf from = unit_columns(source.heights), to = unit_columns(target.heights);
  const Eigen::MatrixXf cosines = from.transpose() * to;
  const auto is_seen = [](const Eigen::MatrixXf& unit, int sector) { return unit.col(sector).squaredNorm() > 0.0F; };
  ScanContextMatch best;
  for (int shift = 0; shift < ScanContext::kSectors; ++shift) {
    double sum = 0.0;
    int n = 0;
    for (int a = 0; a < ScanContext::kSectors; ++a) {
      const int b = (a + shift) % ScanContext::kSectors;
      if (!is_seen(from, a) || !is_seen(to, b)) continue;
      sum += static_cast<double>(cosines(a, b));
      ++n;
    }
    const double distance = n > 0 ? 1.0 - sum / n : 1.0;
    if (distance < best.distance) best = {distance, 2.0 * std::numbers::pi * shift / ScanContext::kSectors};
  }
  return best;
}

}  // namespace cmap
