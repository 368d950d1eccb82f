#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "bytes/scalar_type.hpp"
#include "cmap/io/recording.hpp"

namespace cmap {

/// What the numbers in a cloud's field of times mean. One object serves a topic: what the first scan shows stays, as a
/// later one may hold too few points to show it.
class PointTimes {
 public:
  explicit PointTimes(PointTimeUnit unit = PointTimeUnit::kAuto) : unit_(unit) {}

  /// Turns values, some of which may not be finite, into seconds from the stamp; where they are of a clock, 0 is none
  /// of them and becomes NaN. Throws InputError where they cannot be times of one scan, whatever the unit.
  void to_offsets(std::span<double> values, std::string_view field, ScalarType type, std::int64_t stamp_ns);

 private:
  void decide(std::span<const double> values, std::string_view field, ScalarType type, double stamp_s);

  PointTimeUnit unit_;
  bool is_decided_ = false;
  bool is_clock_ = false;  ///< times of the clock that stamps are of
};

}  // namespace cmap
