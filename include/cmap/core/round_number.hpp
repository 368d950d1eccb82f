#pragma once

namespace cmap {

/// The end of a scale: a number with one digit, or 1.5 times a power of ten, that is at least `value`; 1 for values
/// that are not above 0.
double round_number_above(double value);

}  // namespace cmap
