#include "cmap/core/options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

std::string wrong_number(double v, const NumberRange& range) {
  return range.holds(v) ? "" : fmt::format("{} {}", v, range.text());
}

/// What is wrong with a value, empty for nothing.
struct Complaint {
  std::string operator()(const NumberValue& v) const { return wrong_number(*v.value, v.range); }
  std::string operator()(const OptionalNumberValue& v) const {
    return v.value->has_value() ? wrong_number(**v.value, v.range) : "";
  }
  std::string operator()(const WholeNumberValue& v) const { return wrong_number(*v.value, v.range); }
  std::string operator()(const CountValue& v) const {
    if (*v.value >= v.range.least && *v.value <= v.range.most) return "";
    return fmt::format("{} is not a whole number from {} to {}", *v.value, v.range.least, v.range.most);
  }
  std::string operator()(const VectorValue& v) const { return first_of(v.first, v.first + v.size, kAnyNumber); }
  std::string operator()(const NumbersValue& v) const { return first_of(v.value->begin(), v.value->end(), v.range); }
  std::string operator()(const WholeNumbersValue& v) const {
    return first_of(v.value->begin(), v.value->end(), v.range);
  }
  std::string operator()(const ChoiceValue& v) const { return v.place() < v.names.size() ? "" : "has no such value"; }
  std::string operator()(const auto&) const { return ""; }  // checked where they are set

 private:
  template <class Iterator>
  static std::string first_of(Iterator begin, Iterator end, const NumberRange& range) {
    for (; begin != end; ++begin) {
      if (std::string wrong = wrong_number(*begin, range); !wrong.empty()) return wrong;
    }
    return "";
  }
};

}  // namespace

bool NumberRange::holds(double v) const { return std::isfinite(v) && v <= high && (above_low ? v > low : v >= low); }

std::string NumberRange::text() const {
  constexpr double kFar = std::numeric_limits<double>::max();
  if (low == -kFar) return "must be a finite number";
  const std::string lower = fmt::format("must be {} {}", above_low ? "above" : "at least", low);
  return high == kFar ? lower : fmt::format("{} and at most {}", lower, high);
}

void check_options(const OptionFields& fields, const std::string& where) {
  for (const OptionField& field : fields) {
    const std::string wrong = std::visit(Complaint(), field.value);
    if (!wrong.empty()) throw UsageError(fmt::format("{}: {}: {}", where, field.name, wrong));
  }
}

OptionFields joined(const std::vector<OptionFields>& lists) {
  OptionFields all;
  for (const OptionFields& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::vector<std::string> names_of(const OptionFields& fields) {
  std::vector<std::string> names;
  for (const OptionField& field : fields) names.emplace_back(field.name);
  return names;
}

}  // namespace cmap
