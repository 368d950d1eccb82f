#include "clouds/packed_floats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

constexpr std::uint32_t kFirstInexact = 1U << 24;  // from where on floats miss some of the integers

/// Between one and the largest packed integer: as bits, such a float would have an opacity of 0x3F to 0x4F, which
/// nobody writes, as opacities are 0 or 255 where there is no use for them.
bool is_integer_value(float value) { return value >= 1.0F && value <= 4294967296.0F; }

/// What one more in the last printed digit adds: 1e-43 of "2.34184e-38".
double unit_of_last_digit(std::string_view token) {
  const std::size_t e = std::min(token.find_first_of("eE"), token.size());
  int exponent = 0;
  if (e < token.size()) {
    const std::size_t digits = e + 1 + (token.substr(e + 1).starts_with('+') ? 1 : 0);
    std::from_chars(token.data() + digits, token.data() + token.size(), exponent);
  }
  const std::size_t point = token.substr(0, e).find('.');
  const int decimals = point == std::string_view::npos ? 0 : static_cast<int>(e - point - 1);
  return std::pow(10.0, exponent - decimals);
}

std::size_t n_digits(std::string_view token) {
  const std::string_view mantissa = token.substr(0, token.find_first_of("eE"));
  return static_cast<std::size_t>(
      std::count_if(mantissa.begin(), mantissa.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

/// How far the bits of a float that was printed like this may be off, as an integer.
double error_of_bits(std::string_view token, float value) {
  const float size = std::abs(value);
  const double step =
      static_cast<double>(std::nextafter(size, std::numeric_limits<float>::infinity())) - static_cast<double>(size);
  return 0.5 * unit_of_last_digit(token) / step;
}

}  // namespace

void PackedFloats::add(float value) {
  if (!is_integer_value(value)) return;
  if (n_numbers_++ == 0) number_ = value;
}

void PackedFloats::add_printed(std::string_view token, float value) {
  add(value);
  if (!std::isfinite(value) || value == 0.0F || is_integer_value(value)) return;
  ++n_printed_;
  const double error = error_of_bits(token, value);
  if (error < 1.0) return;
  ++n_rounded_;
  // Digits that are zero are often left out: those that have most show how many there were.
  const std::size_t digits = n_digits(token);
  if (digits > most_digits_) {
    most_digits_ = digits;
    largest_error_ = 0.0;
  }
  if (digits < most_digits_ || error <= largest_error_) return;
  largest_error_ = error;
  example_ = token;
}

void PackedFloats::add_whole(std::uint32_t packed) {
  if (packed < kFirstInexact) return;
  ++n_whole_;
  whole_bits_ |= packed;
}

void PackedFloats::add(const PackedFloats& others) {
  if (n_numbers_ == 0) number_ = others.number_;
  n_numbers_ += others.n_numbers_;
  n_whole_ += others.n_whole_;
  whole_bits_ |= others.whole_bits_;
  n_printed_ += others.n_printed_;
  n_rounded_ += others.n_rounded_;
  if (others.most_digits_ <= most_digits_) return;
  most_digits_ = others.most_digits_;
  largest_error_ = others.largest_error_;
  example_ = others.example_;
}

std::string PackedFloats::why_no_color() const {
  constexpr std::uint64_t kFewest = 20;  // among which blue may be zero throughout
  constexpr std::string_view kRemedy = "write them as integers (PCD: TYPE U), or red, green and blue";
  if (n_numbers_ > 0) {
    return fmt::format(
        "no color: {} packed colors are floats whose value is the packed integer ({:g}), not floats of "
        "its bits; its last digits may be lost: {}",
        n_numbers_, number_, kRemedy);
  }
  if (n_whole_ >= kFewest && (whole_bits_ & 0xffU) == 0) {
    return fmt::format(
        "no color: the packed colors are multiples of 256, as if they had been floats, which do not hold "
        "such integers: {}",
        kRemedy);
  }
  return {};
}

std::optional<Warning> PackedFloats::rounded() const {
  constexpr double kMany = 0.1;  // some numbers have few digits by chance
  if (n_rounded_ == 0 || static_cast<double>(n_rounded_) < kMany * static_cast<double>(n_printed_)) return std::nullopt;
  return Warning{
      "packed_colors_rounded",
      fmt::format("{} of {} packed colors are printed with too few digits ({}): blue may be off by {:.0f} of "
                  "255; 9 digits keep them",
                  n_rounded_, n_printed_, example_, std::min(255.0, std::ceil(largest_error_)))};
}

}  // namespace cmap
