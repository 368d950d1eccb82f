#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace cmap {

/// A sum of doubles that neither the order nor the grouping of its terms changes: every term is rounded to a multiple
/// of 2^-72 (by at most 1.1e-22, ties to even), and those are added without error. The sums of parts, merged, have the
/// bits of the sum of the whole. NaN, infinity and terms from 2^262 on are refused with std::invalid_argument.
///
/// Terms gather in three windows of multiples of 2^-8, 2^-40 and 2^-72, whose sums are exact in double for 2^16 terms
/// (pre-rounding after Demmel and Nguyen 2015, "Parallel Reproducible Summation"), and then move to a wide integer (as
/// in Neal 2015, "Fast exact summation using small and large superaccumulators"). Not thread-safe: every thread sums a
/// part of its own.
class ExactSum {
 public:
  void add(double term) {
    if (!(std::abs(term) < kWindowLimit)) {
      add_wide(term);
      return;
    }
    const double high = (term + kHigh) - kHigh;
    const double rest = term - high;
    const double middle = (rest + kMiddle) - kMiddle;
    high_ += high;
    middle_ += middle;
    low_ += ((rest - middle) + kLow) - kLow;
    if (++n_pending_ == kMostPending) settle();
  }

  /// The same for each of them, at about the cost of a plain sum.
  void add(std::span<const double> terms);

  ExactSum& operator+=(const ExactSum& other);

  /// The double nearest to the sum, ties to even.
  double value() const;

  /// The sum in units of 2^-72, in two's complement, the least significant word first: what is stored and compared.
  using Words = std::array<std::uint64_t, 6>;
  Words words() const;
  static ExactSum from_words(const Words& words);

  friend bool operator==(const ExactSum& a, const ExactSum& b) { return a.words() == b.words(); }

 private:
  // Adding and taking off 1.5 x 2^52 units rounds to whole units.
  static constexpr double kHigh = 0x1.8p44, kMiddle = 0x1.8p12, kLow = 0x1.8p-20;
  static constexpr double kWindowLimit = 0x1p29;
  static constexpr std::uint32_t kMostPending = 1u << 16;

  void add_wide(double term);
  void add_piece(std::span<const double> terms);
  void settle();

  double high_ = 0.0, middle_ = 0.0, low_ = 0.0;
  std::uint32_t n_pending_ = 0;
  Words words_{};
};

}  // namespace cmap
