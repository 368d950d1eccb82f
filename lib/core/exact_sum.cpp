#include "cmap/core/exact_sum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <stdexcept>

namespace cmap {
namespace {

using Words = ExactSum::Words;

constexpr int kUnitBits = 72;  // units of 2^-72
constexpr int kWordBits = 64;
constexpr int kMantissaBits = 53;
__extension__ using Wide = __int128;

bool is_negative(const Words& words) { return words.back() >> (kWordBits - 1) != 0; }

/// Adds value x 2^bit units; what lies above a word goes on into the next ones, sign included.
void add_at(Words& words, std::int64_t value, int bit) {
  const Wide shifted = static_cast<Wide>(value) << (bit % kWordBits);
  const std::uint64_t sign = value < 0 ? ~std::uint64_t{0} : 0;
  const std::uint64_t parts[]{static_cast<std::uint64_t>(shifted), static_cast<std::uint64_t>(shifted >> kWordBits)};
  unsigned carry = 0;
  const auto first = static_cast<std::size_t>(bit / kWordBits);
  for (std::size_t i = first; i < words.size(); ++i) {
    const std::uint64_t part = i - first < 2 ? parts[i - first] : sign;
    const std::uint64_t sum = words[i] + part;
    const std::uint64_t total = sum + carry;
    carry = (sum < part ? 1u : 0u) | (total < sum ? 1u : 0u);
    words[i] = total;
  }
}

void add_words(Words& words, const Words& other) {
  unsigned carry = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint64_t sum = words[i] + other[i];
    const std::uint64_t total = sum + carry;
    carry = (sum < other[i] ? 1u : 0u) | (total < sum ? 1u : 0u);
    words[i] = total;
  }
}

Words negated(Words words) {
  for (std::uint64_t& word : words) word = ~word;
  add_at(words, 1, 0);
  return words;
}

bool bit_at(const Words& words, int bit) {
  return (words[static_cast<std::size_t>(bit / kWordBits)] >> (bit % kWordBits) & 1) != 0;
}

/// Bits up to the highest that is set.
int bit_length(const Words& words) {
  for (std::size_t i = words.size(); i > 0; --i) {
    if (words[i - 1] != 0) return static_cast<int>(i) * kWordBits - std::countl_zero(words[i - 1]);
  }
  return 0;
}

/// Rounded to 53 bits, ties to even.
double magnitude(const Words& words) {
  const int length = bit_length(words);
  const int dropped = std::max(0, length - kMantissaBits);
  std::uint64_t mantissa = 0;
  for (int bit = length - 1; bit >= dropped; --bit) mantissa = mantissa << 1 | (bit_at(words, bit) ? 1u : 0u);
  if (dropped > 0 && bit_at(words, dropped - 1)) {
    bool above_half = false;
    for (int bit = 0; bit < dropped - 1 && !above_half; ++bit) above_half = bit_at(words, bit);
    if (above_half || (mantissa & 1) != 0) ++mantissa;
  }
  return std::ldexp(static_cast<double>(mantissa), dropped - kUnitBits);
}

}  // namespace

void ExactSum::add_wide(double term) {
  constexpr double kLimit = 0x1p262;  // 2^48 of them fit the words
  if (!(std::abs(term) < kLimit)) throw std::invalid_argument("ExactSum: NaN, infinite or too large a term");
  int exponent = 0;
  const double mantissa = std::frexp(term, &exponent);  // of 53 bits: whole units, as the term is at least 2^29
  const auto integer = static_cast<std::int64_t>(std::ldexp(mantissa, kMantissaBits));
  add_at(words_, integer, exponent - kMantissaBits + kUnitBits);
}

void ExactSum::settle() {
  add_at(words_, static_cast<std::int64_t>(high_ * 0x1p8), kUnitBits - 8);
  add_at(words_, static_cast<std::int64_t>(middle_ * 0x1p40), kUnitBits - 40);
  add_at(words_, static_cast<std::int64_t>(low_ * 0x1p72), 0);
  high_ = middle_ = low_ = 0.0;
  n_pending_ = 0;
}

/// At most as many terms as still fit the windows.
void ExactSum::add_piece(std::span<const double> terms) {
  using Lanes = Eigen::Array<double, 4, 1>;
  constexpr std::size_t kLanes = 4;
  std::size_t in_lanes = terms.size() / kLanes * kLanes;
  Lanes high = Lanes::Zero(), middle = Lanes::Zero(), low = Lanes::Zero(), largest = Lanes::Zero();
  for (std::size_t i = 0; i < in_lanes; i += kLanes) {
    const Lanes term = Eigen::Map<const Lanes>(terms.data() + i);
    const Lanes whole = (term + kHigh) - kHigh;
    const Lanes rest = term - whole;
    const Lanes part = (rest + kMiddle) - kMiddle;
    high += whole;
    middle += part;
    low += ((rest - part) + kLow) - kLow;
    largest = largest.max(term.abs());
  }
  // NaN may pass the largest by, but not the sums.
  if (largest.maxCoeff() < kWindowLimit && high.allFinite()) {
    high_ += high.sum();
    middle_ += middle.sum();
    low_ += low.sum();
  } else {
    in_lanes = 0;
  }
  n_pending_ += static_cast<std::uint32_t>(in_lanes);
  if (n_pending_ == kMostPending) settle();
  for (const double term : terms.subspan(in_lanes)) add(term);
}

void ExactSum::add(std::span<const double> terms) {
  while (!terms.empty()) {
    const std::size_t n = std::min<std::size_t>(terms.size(), kMostPending - n_pending_);
    add_piece(terms.first(n));
    terms = terms.subspan(n);
  }
}

ExactSum& ExactSum::operator+=(const ExactSum& other) {
  settle();
  add_words(words_, other.words());
  return *this;
}

Words ExactSum::words() const {
  ExactSum settled = *this;
  settled.settle();
  return settled.words_;
}

ExactSum ExactSum::from_words(const Words& words) {
  ExactSum sum;
  sum.words_ = words;
  return sum;
}

double ExactSum::value() const {
  const Words total = words();
  return is_negative(total) ? -magnitude(negated(total)) : magnitude(total);
}

}  // namespace cmap
