#include "cmap/eval/metric_sums.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cmap/metrics/color_distance.hpp"
#include "cmap/metrics/geometry.hpp"

namespace cmap {
namespace {

/// Looks up columns; those of a threshold end in its text.
class Lookup {
 public:
  Lookup(const MetricTotals& totals, std::string suffix = "") : totals_(totals), suffix_(std::move(suffix)) {}

  double operator()(const std::string& name) const {
    const auto column = totals_.find(name + suffix_);
    return column == totals_.end() ? std::nan("") : column->second;
  }
  double whole(const std::string& name) const { return totals_.at(name); }
  double ratio(const std::string& sum, const std::string& n) const { return (*this)(sum) / (*this)(n); }
  bool has(const std::string& name) const { return totals_.contains(name + suffix_); }

 private:
  const MetricTotals& totals_;
  std::string suffix_;
};

double mean_of_both(const Lookup& sum, const std::string& value, const std::string& n) {
  return 0.5 * (sum.ratio("estimate." + value, "estimate." + n) + sum.ratio("reference." + value, "reference." + n));
}

double precision(const Lookup& within) { return within("estimate.n") / within.whole("estimate.n"); }
double recall(const Lookup& within) { return within("reference.n") / within.whole("reference.n"); }

/// Sum over the points that have a color; reports of before, when all had to, do not count them apart.
double per_colored(const Lookup& sum, const std::string& value, const std::string& colored, const std::string& all) {
  return sum.ratio(value, sum.has(colored) ? colored : all);
}

/// Of the worse direction, as color_psnr.
double psnr_db(const Lookup& sum) {
  const auto mse = [&](const std::string& map) {
    return Eigen::Vector3d::Constant(per_colored(sum, map + "sq_luma", map + "luma_n", map + "n")).eval();
  };
  const ColorPsnr psnr{mse("estimate."), mse("reference.")};
  return psnr.psnr_db().x();
}

/// A metric's formula, and a column without which it has none.
struct Formula {
  std::string_view id;
  const char* needs;
  double (*value)(const Lookup&);
};

constexpr Formula kFormulas[] = {
    {"color_distance", "estimate.color_distance",
     [](const Lookup& s) { return mean_of_both(s, "color_distance", "color_n"); }},
    {"color_fidelity", "estimate.color_distance",
     [](const Lookup& s) { return color_fidelity_db(mean_of_both(s, "color_distance", "color_n")); }},
    {"local_color_recall", "reference.recalled",
     [](const Lookup& s) { return per_colored(s, "reference.recalled", "reference.colored", "reference.n"); }},
    {"color_consistency", "color_spread.n",
     [](const Lookup& s) { return s.ratio("color_spread.sum", "color_spread.n"); }},
    {"delta_e", "estimate.delta_e", [](const Lookup& s) { return mean_of_both(s, "delta_e", "delta_e_n"); }},
    {"color_distance_exposure_free", "estimate.exposure_free",
     [](const Lookup& s) { return mean_of_both(s, "exposure_free", "color_n"); }},
    {"color_psnr", "estimate.sq_luma", psnr_db},
    {"chamfer", "estimate.distance", [](const Lookup& s) { return 2.0 * mean_of_both(s, "distance", "n"); }},
    {"overlap", "estimate.overlapping", [](const Lookup& s) { return s.ratio("estimate.overlapping", "estimate.n"); }},
    {"rmse", "estimate.sq_distance",
     [](const Lookup& s) { return std::sqrt(s.ratio("estimate.sq_distance", "estimate.n")); }},
    {"average_wasserstein", "wasserstein.n",
     [](const Lookup& s) { return s.ratio("wasserstein.sum", "wasserstein.n"); }},
    {"spatial_consistency", "variation.n", [](const Lookup& s) { return s.ratio("variation.sum", "variation.n"); }},
    {"mean_map_entropy", "entropy.n", [](const Lookup& s) { return s.ratio("entropy.sum", "entropy.n"); }},
};

constexpr Formula kThresholdFormulas[] = {
    {"accuracy", "estimate.sq_distance",
     [](const Lookup& s) { return std::sqrt(s.ratio("estimate.sq_distance", "estimate.n")); }},
    {"fitness", "estimate.n", precision},
    {"completeness", "reference.n", recall},
    {"f_score", "reference.n", [](const Lookup& s) { return f_score(precision(s), recall(s)); }},
};

constexpr std::string_view kThresholdColumn = "estimate.n<=";

/// The texts "<=0.1" after the columns' names, the largest threshold first as in the options' default.
std::vector<std::pair<double, std::string>> thresholds_of(const MetricTotals& totals) {
  std::vector<std::pair<double, std::string>> thresholds;
  for (const auto& [name, sum] : totals) {
    if (!name.starts_with(kThresholdColumn)) continue;
    const std::string_view text = std::string_view(name).substr(kThresholdColumn.size());
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    thresholds.emplace_back(value, "<=" + std::string(text));
  }
  std::ranges::sort(thresholds, std::greater<>());
  return thresholds;
}

}  // namespace

MetricTotals totals_of(const MetricSums& sums, std::span<const double> weights) {
  MetricTotals totals;
  for (const auto& [name, parts] : sums.columns) {
    double total = 0.0;
    for (std::size_t part = 0; part < sums.n_parts; ++part) total += weights[part] * parts[part];
    totals[name] = total;
  }
  return totals;
}

std::vector<SummedValue> values_of(const MetricTotals& totals) {
  std::vector<SummedValue> values;
  const Lookup all(totals);
  for (const Formula& formula : kFormulas) {
    if (all.has(formula.needs)) values.push_back({formula.id, std::nullopt, formula.value(all)});
  }
  const auto thresholds = thresholds_of(totals);
  for (const Formula& formula : kThresholdFormulas) {
    for (const auto& [threshold_m, suffix] : thresholds) {
      const Lookup within(totals, suffix);
      if (within.has(formula.needs)) values.push_back({formula.id, threshold_m, formula.value(within)});
    }
  }
  return values;
}

}  // namespace cmap
