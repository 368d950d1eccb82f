#include "cmap/colorize/weighted_median.hpp"

#include <algorithm>
#include <limits>

namespace cmap {

float weighted_median(std::span<WeightedValue> values) {
  if (values.empty()) return std::numeric_limits<float>::quiet_NaN();
  std::ranges::sort(values, [](const WeightedValue& a, const WeightedValue& b) {
    return a.value < b.value || (a.value == b.value && a.weight < b.weight);
  });
  float total = 0.0f;
  for (const WeightedValue& v : values) total += v.weight;
  const float half = 0.5f * total;
  float before = 0.0f;  // weight of those passed
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float place = before + 0.5f * values[i].weight;
    if (place >= half) {
      if (i == 0) return values[0].value;
      const float last = before - 0.5f * values[i - 1].weight;
      return values[i - 1].value + (values[i].value - values[i - 1].value) * (half - last) / (place - last);
    }
    before += values[i].weight;
  }
  return values.back().value;
}

}  // namespace cmap
