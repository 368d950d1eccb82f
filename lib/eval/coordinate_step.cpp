#include "coordinate_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cmap/core/sampled_indices.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr std::size_t kStepSample = 10000;
constexpr std::size_t kFewestCoordinates = 4;  // below, anything may be chance
constexpr double kShare = 0.1;                 // of the coordinates that must be coarse

/// One axis of the sample: what the file said, as far as our offsets kept it, and how well they did.
struct Axis {
  std::vector<double> world;
  std::vector<double> rounding_m;  ///< distance of float32 numbers at the offset

  double largest() const {
    return *std::ranges::max_element(world, {}, [](double x) { return std::abs(x); });
  }
};

constexpr int kFloat32Bits = 24, kFloat16Bits = 11;

/// Distance of neighboring floating-point numbers of that many bits at x.
double float_step(double x, int bits) { return x == 0.0 ? 0.0 : std::ldexp(1.0, std::ilogb(x) + 1 - bits); }

std::array<Axis, 3> sampled_axes(const PointCloud& cloud) {
  std::array<Axis, 3> axes;
  for (const std::size_t i : sampled_indices(cloud.size(), kStepSample)) {
    const Eigen::Vector3d offset = cloud.positions[i].cast<double>();
    for (int a = 0; a < 3; ++a) {
      Axis& axis = axes[static_cast<std::size_t>(a)];
      axis.world.push_back(cloud.origin[a] + offset[a]);
      axis.rounding_m.push_back(float_step(offset[a], kFloat32Bits));
    }
  }
  return axes;
}

/// The value that a tenth of them reach, so that single far points do not decide.
double reached_by_share(std::vector<double> values) {
  const long n_above = std::max(1L, std::lround(kShare * static_cast<double>(values.size())));
  return value_at_rank(values, values.size() - static_cast<std::size_t>(n_above));
}

/// Whether all values are whole multiples of the step, as far as our own rounding lets one see.
bool all_multiples(const Axis& axis, double step_m) {
  for (std::size_t i = 0; i < axis.world.size(); ++i) {
    const double rounding_m = 0.51 * axis.rounding_m[i];
    const double from_multiple_m = std::abs(axis.world[i] - std::round(axis.world[i] / step_m) * step_m);
    if (rounding_m > step_m / 8.0 || from_multiple_m > rounding_m + 1e-15 * std::abs(axis.world[i])) return false;
  }
  return true;
}

/// The coarsest power of ten of which all values are multiples, as printed numbers are; 0 where none is seen.
double printed_step_m(const Axis& axis) {
  for (double step_m = 1.0; step_m > 1e-7; step_m /= 10.0) {
    if (all_multiples(axis, step_m)) return step_m;
  }
  return 0.0;
}

/// What an axis says of numbers of so many bits.
struct BinaryAxis {
  bool against = false;
  double step_m = 0.0;  ///< of such numbers at its coordinates; 0 where it says nothing
};

/// An axis speaks for such numbers where those that are coarser than the limit are multiples of their steps, as far as
/// printing and our own rounding let one see, both even and odd ones (coordinates of a raster are multiples by chance).
BinaryAxis binary_axis(const Axis& axis, double printed_m, int bits, double limit_m) {
  constexpr std::size_t kFewestRounded = 20;  // printed numbers are multiples by a chance of up to one in four each
  std::vector<double> steps;
  std::size_t n_odd = 0, n_seen = 0;
  bool exact = true;
  for (std::size_t i = 0; i < axis.world.size(); ++i) {
    const double x = std::abs(axis.world[i]), step_m = float_step(x, bits);
    steps.push_back(step_m);
    const double own_rounding_m = 0.51 * axis.rounding_m[i] + 1e-15 * x, rounding_m = own_rounding_m + 0.5 * printed_m;
    if (step_m <= limit_m || rounding_m > step_m / 8.0) continue;
    const double multiple = std::round(x / step_m), from_multiple_m = std::abs(x - multiple * step_m);
    if (from_multiple_m > rounding_m) return {true};
    exact = exact && from_multiple_m <= own_rounding_m;
    ++n_seen;
    n_odd += std::fmod(multiple, 2.0) == 1.0 ? 1U : 0U;
  }
  const double step_m = reached_by_share(steps);
  if (step_m <= limit_m || n_seen < (exact ? kFewestCoordinates : kFewestRounded)) return {};
  const double odd_share = static_cast<double>(n_odd) / static_cast<double>(n_seen);
  if (odd_share <= kShare || odd_share >= 1.0 - kShare) return {true};
  return {false, step_m};
}

/// Whether the values differ by single steps too: in a raster of 0.2, 0.25 or 0.5 they do not.
bool uses_every_step(const Axis& axis, double step_m) {
  const std::int64_t first = std::llround(axis.world.front() / step_m);
  std::int64_t divisor = 0;
  for (const double x : axis.world) divisor = std::gcd(divisor, std::llround(x / step_m) - first);
  return divisor == 1;
}

/// The largest power of ten of which all values are multiples, if it is coarser than the limit; 0 otherwise. Near zero
/// only tenths and hundredths of many points are believed: whole meters there are a grid that somebody laid out.
double decimal_step(const Axis& axis, double limit_m) {
  constexpr double kSixDigits = 1e5;
  constexpr std::size_t kMany = 100;
  const bool large = std::abs(axis.largest()) >= kSixDigits;
  if (!large && axis.world.size() < kMany) return 0.0;
  for (const double step_m : {100.0, 10.0, 1.0, 0.1, 0.01, 0.001}) {
    if (step_m <= limit_m) break;
    if ((!large && step_m >= 1.0) || !all_multiples(axis, step_m)) continue;
    return uses_every_step(axis, step_m) ? step_m : 0.0;
  }
  return 0.0;
}

void keep_coarser(std::optional<CoordinateStep>& coarsest, double step_m, const std::array<Axis, 3>& axes, int axis,
                  CoordinateStep::Cause cause) {
  if (step_m == 0.0 || (coarsest && coarsest->step_m >= step_m)) return;
  coarsest = CoordinateStep{step_m, axis, axes[static_cast<std::size_t>(axis)].largest(), cause};
}

/// Floats are a property of all three axes: one that speaks against them outweighs the others.
void keep_binary(std::optional<CoordinateStep>& coarsest, const std::array<Axis, 3>& axes,
                 const std::array<double, 3>& printed_m, int bits, double limit_m, CoordinateStep::Cause cause) {
  std::array<BinaryAxis, 3> found;
  for (std::size_t a = 0; a < 3; ++a) found[a] = binary_axis(axes[a], printed_m[a], bits, limit_m);
  if (std::ranges::any_of(found, &BinaryAxis::against)) return;
  for (int a = 0; a < 3; ++a) keep_coarser(coarsest, found[static_cast<std::size_t>(a)].step_m, axes, a, cause);
}

/// Whether all values are so many steps from the first, both even and odd ones.
bool is_in_steps(const Axis& axis, double step_m) {
  std::size_t n_odd = 0;
  for (std::size_t i = 0; i < axis.world.size(); ++i) {
    const double rounding_m = 0.51 * (axis.rounding_m[i] + axis.rounding_m[0]);
    const double steps = (axis.world[i] - axis.world[0]) / step_m, whole = std::round(steps);
    if (rounding_m > step_m / 8.0 || std::abs(steps - whole) * step_m > rounding_m + 1e-15 * std::abs(axis.world[i])) {
      return false;
    }
    n_odd += std::fmod(std::abs(whole), 2.0) == 1.0 ? 1U : 0U;
  }
  const double odd_share = static_cast<double>(n_odd) / static_cast<double>(axis.world.size());
  return odd_share > kShare && odd_share < 1.0 - kShare;
}

/// Floats near zero are finer: where an axis there comes in the steps of a far one, they are not those of floats.
bool is_grid(const std::array<Axis, 3>& axes, const CoordinateStep& step, int bits) {
  return std::ranges::any_of(axes, [&](const Axis& axis) {
    return 2.0 * float_step(axis.largest(), bits) <= step.step_m && is_in_steps(axis, step.step_m);
  });
}

}  // namespace

std::optional<CoordinateStep> coarse_step(const PointCloud& cloud, double limit_m) {
  using enum CoordinateStep::Cause;
  if (cloud.size() < kFewestCoordinates) return std::nullopt;
  const std::array<Axis, 3> axes = sampled_axes(cloud);
  std::optional<CoordinateStep> coarsest;
  const std::array<double, 3> printed_m{printed_step_m(axes[0]), printed_step_m(axes[1]), printed_step_m(axes[2])};
  keep_binary(coarsest, axes, printed_m, kFloat16Bits, limit_m, kFloat16);
  keep_binary(coarsest, axes, printed_m, kFloat32Bits, limit_m, kFloat32);
  if (coarsest && is_grid(axes, *coarsest, coarsest->cause == kFloat16 ? kFloat16Bits : kFloat32Bits)) {
    coarsest->cause = kGrid;
  }
  for (int a = 0; a < 3; ++a) {
    const Axis& axis = axes[static_cast<std::size_t>(a)];
    const double held_m = reached_by_share(axis.rounding_m);
    keep_coarser(coarsest, held_m > limit_m ? held_m : 0.0, axes, a, kOwnOffsets);
    keep_coarser(coarsest, decimal_step(axis, limit_m), axes, a, kDigits);
  }
  return coarsest;
}

}  // namespace cmap
