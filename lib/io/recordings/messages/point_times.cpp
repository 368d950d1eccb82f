#include "recordings/messages/point_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// No scan takes longer, and no stamp is farther from its points.
constexpr double kFarthest_s = 60.0;
constexpr std::array kUnits{PointTimeUnit::kSeconds, PointTimeUnit::kMilliseconds, PointTimeUnit::kMicroseconds,
                            PointTimeUnit::kNanoseconds};

double seconds_of(PointTimeUnit unit) {
  switch (unit) {
    case PointTimeUnit::kMilliseconds:
      return 1e-3;
    case PointTimeUnit::kMicroseconds:
      return 1e-6;
    case PointTimeUnit::kNanoseconds:
      return 1e-9;
    default:
      return 1.0;
  }
}

/// The largest size of the values that are finite.
double largest(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  }
  return most;
}

/// Whether all values, but those that are not finite, are so small. Without a maximum, each of which waits for the
/// last.
bool are_within(std::span<const double> values, double most) {
  std::size_t n_beyond = 0;
  for (const double value : values) n_beyond += std::abs(value) > most ? 1U : 0U;
  return n_beyond == 0 || largest(values) <= most;
}

/// Whole numbers: nanoseconds, as Ouster's t and nebula's time_stamp, unless the name ends in another unit.
PointTimeUnit unit_of_name(std::string_view field) {
  if (field.ends_with("_us")) return PointTimeUnit::kMicroseconds;
  if (field.ends_with("_ms")) return PointTimeUnit::kMilliseconds;
  return PointTimeUnit::kNanoseconds;
}

/// Floating-point offsets: no scan takes 3 s, and none is as short as 3 ms.
PointTimeUnit unit_of_size(double most) {
  constexpr double kLongest_s = 3.0;
  for (const PointTimeUnit unit :
       {PointTimeUnit::kSeconds, PointTimeUnit::kMilliseconds, PointTimeUnit::kMicroseconds}) {
    if (most * seconds_of(unit) <= kLongest_s) return unit;
  }
  return PointTimeUnit::kNanoseconds;
}

}  // namespace

void PointTimes::decide(std::span<const double> values, std::string_view field, ScalarType type, double stamp_s) {
  const double most = largest(values);
  if (most == 0.0) return;  // shows nothing yet
  is_decided_ = true;
  if (type == ScalarType::kFloat64) {
    // Livox gives nanoseconds of the clock, Hesai and RoboSense its seconds.
    constexpr double kNear_s = 1.0;
    for (const PointTimeUnit unit : kUnits) {
      const double time_s = most * seconds_of(unit);
      if ((unit_ != PointTimeUnit::kAuto && unit != unit_) || stamp_s <= 2.0 * kNear_s) continue;
      if (std::abs(time_s - stamp_s) > kNear_s) continue;
      is_clock_ = true;
      unit_ = unit;
      return;
    }
  }
  if (unit_ == PointTimeUnit::kAuto) unit_ = is_floating(type) ? unit_of_size(most) : unit_of_name(field);
}

void PointTimes::to_offsets(std::span<double> values, std::string_view field, ScalarType type, std::int64_t stamp_ns) {
  if (!is_decided_) decide(values, field, type, 1e-9 * static_cast<double>(stamp_ns));
  const double unit_s = seconds_of(unit_);
  const double zero = static_cast<double>(stamp_ns) * (1e-9 / unit_s);
  if (is_clock_) {
    // What drivers fill up a message with has no time.
    for (double& value : values) value = value == 0.0 ? std::numeric_limits<double>::quiet_NaN() : value - zero;
  }
  for (double& value : values) value *= unit_s;
  if (are_within(values, kFarthest_s)) return;
  throw InputError(
      fmt::format("the field '{}' holds times {:g} s from the stamp, in {}; at most {:g} s expected. Is the unit "
                  "another (recording.point_time_unit)?",
                  field, largest(values), name_of(unit_, point_time_unit_names()), kFarthest_s));
}

}  // namespace cmap
