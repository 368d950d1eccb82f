#include "loops/patch_agreement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace cmap {
namespace {

constexpr double kSameFacing = 0.9;
constexpr int kDirections = 6;
constexpr std::array<double, 2> kShiftPatches{4.0, 9.0};

/// Of level patches (ground, roofs) and of upright and slanted ones.
struct Counts {
  std::array<double, 2> common{}, agreeing{};
  double sq_sum = 0.0;
  Counts& operator+=(const Counts& o) {
    for (std::size_t k = 0; k < common.size(); ++k) {
      common[k] += o.common[k];
      agreeing[k] += o.agreeing[k];
    }
    sq_sum += o.sq_sum;
    return *this;
  }
};

Counts counts_at(const PlaneGrid& source, const PlaneGrid& target, const Eigen::Isometry3d& T, double tolerance_m,
                 std::size_t step) {
  Counts counts;
  for (std::size_t i = 0; i < source.patches().size(); i += step) {
    const PlanePatch& patch = source.patches()[i];
    const Eigen::Vector3d p = T * patch.mean;
    if (!target.was_seen(p)) continue;
    const Eigen::Vector3d normal = T.linear() * patch.normal;
    const std::size_t kind = std::abs(normal.z()) > kSameFacing ? 0 : 1;
    counts.common[kind] += 1.0;
    const PlanePatch* const met = target.nearest(p);
    if (met == nullptr || std::abs(met->normal.dot(normal)) < kSameFacing) continue;
    const double across_m = met->normal.dot(p - met->mean);
    if (std::abs(across_m) > tolerance_m || std::abs(normal.dot(p - met->mean)) > tolerance_m) continue;
    counts.agreeing[kind] += 1.0;
    counts.sq_sum += across_m * across_m;
  }
  return counts;
}

Counts chance_about(const PlaneGrid& source, const PlaneGrid& target, const Eigen::Isometry3d& T, double tolerance_m) {
  constexpr std::size_t kStep = 3;
  Counts sum;
  for (const double patches : kShiftPatches) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.05 * patches) / kDirections;
      Eigen::Isometry3d moved = T;
      moved.translation() += patches * target.size_m() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      sum += counts_at(source, target, moved, tolerance_m, kStep);
    }
  }
  return sum;
}

}  // namespace

PatchAgreement agreement_of(const PlaneGrid& source, const PlaneGrid& target, const Eigen::Isometry3d& T,
                            double tolerance_m) {
  constexpr double kPrior = 10.0, kPriorShare = 0.3;  // chance of few patches is uncertain
  const Counts found = counts_at(source, target, T, tolerance_m, 1);
  const Counts chance = chance_about(source, target, T, tolerance_m);
  PatchAgreement result;
  double agreeing = 0.0, common = 0.0, possible = 0.0;
  for (std::size_t k = 0; k < found.common.size(); ++k) {
    const double p = (chance.agreeing[k] + kPrior * kPriorShare) / (chance.common[k] + kPrior);
    common += found.common[k];
    agreeing += found.agreeing[k];
    result.places += found.agreeing[k] - p * found.common[k];
    possible += (1.0 - p) * found.common[k];
  }
  result.share = common > 0.0 ? agreeing / common : 0.0;
  result.score = possible > 0.0 ? std::max(0.0, result.places / possible) : 0.0;
  result.places = std::max(0.0, result.places);
  result.rmse_m = agreeing > 0.0 ? std::sqrt(found.sq_sum / agreeing) : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace cmap
