#include <fmt/format.h>

#include "cmap/core/error.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "cmap/metrics/color_distance.hpp"
#include "eval/json_number.hpp"
#include "eval/metric_records.hpp"
#include "eval/record_list.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

ColorDistanceOptions pairs_that_count(const EvaluationOptions& options) {
  ColorDistanceOptions pairs;
  pairs.max_distance_m = options.color_max_distance_m.value_or(INFINITY);
  return pairs;
}

Json max_distance_parameter(const EvaluationOptions& options) {
  return {{"max_distance_m", json_number(options.color_max_distance_m.value_or(INFINITY))}};
}

/// The points whose color is missing, where there are any: what the metric left out.
void add_without_color(Json& fields, const MapPair& pair) {
  if (pair.estimate.n_without_color + pair.reference.n_without_color == 0) return;
  fields["n_without_color_estimate"] = pair.estimate.n_without_color;
  fields["n_without_color_reference"] = pair.reference.n_without_color;
}

Json color_distance_fields(const EvaluationOptions& options, const MapPair& pair, const ColorDistance& cd,
                           std::vector<Warning>& warnings) {
  if (std::isnan(cd.value())) {
    warnings.push_back({"color_distance_no_pairs",
                        "no pair of nearest points counts in both directions (both need a "
                        "color, within color-max-distance): no color distance"});
  }
  Json fields{{"value", json_number(cd.value())},
              {"value_8bit", json_number(255.0 * cd.value())},
              {"parameters", max_distance_parameter(options)},
              {"estimate_to_reference", json_number(cd.estimate_to_reference.mean)},
              {"reference_to_estimate", json_number(cd.reference_to_estimate.mean)},
              {"n_estimate", cd.estimate_to_reference.n},
              {"n_reference", cd.reference_to_estimate.n}};
  add_without_color(fields, pair);
  if (options.color_max_distance_m || fields.contains("n_without_color_estimate")) {
    fields["n_unmatched_estimate"] = cd.estimate_to_reference.n_unmatched;
    fields["n_unmatched_reference"] = cd.reference_to_estimate.n_unmatched;
  }
  return fields;
}

Json fidelity_fields(const EvaluationOptions& options, const ColorDistance& cd, std::vector<Warning>& warnings) {
  const double cf = color_fidelity_db(cd.value());
  if (std::isinf(cf)) {
    warnings.push_back(
        {"color_fidelity_infinite", "every color is exact: color fidelity is infinite, which is null in JSON"});
  }
  return {{"value", json_number(cf)}, {"parameters", max_distance_parameter(options)}};
}

Json recall_fields(const EvaluationOptions& options, const MapPair& pair, const LocalColorRecall& recall) {
  Json fields{{"value", json_number(recall.value())},
              {"coverage", json_number(recall.coverage())},
              {"conditional", json_number(recall.conditional())},
              {"parameters", {{"tau", options.lcr_tau}, {"radius_m", options.lcr_radius_m}}},
              {"n_reference", recall.n_reference},
              {"n_covered", recall.n_covered},
              {"n_recalled", recall.n_recalled}};
  add_without_color(fields, pair);
  if (options.lcr_curve) {
    fields["curve"] = {{"tau", recall.curve.tau}, {"value", recall.curve.value}, {"area", recall.curve.area}};
  }
  return fields;
}

Json consistency_numbers(const IndexedMap& map, const ColorConsistency& c, Singletons singletons) {
  const double value = c.value(singletons);
  Json numbers{{"value", json_number(value)},     {"value_x100", json_number(100.0 * value)},
               {"zero", json_number(c.zero)},     {"exclude", json_number(c.exclude)},
               {"median", json_number(c.median)}, {"n_voxels", c.n_voxels(singletons)},
               {"n_occupied", c.n_occupied},      {"n_singletons", c.n_singletons}};
  if (map.n_without_color > 0) numbers["n_without_color"] = map.n_without_color;
  return numbers;
}

/// Copies of a point do not make a voxel any less a single one.
void warn_of_singletons(const EvaluationOptions& o, const ColorConsistency& c, std::vector<Warning>& warnings) {
  const std::uint64_t n_single = c.n_singletons + c.n_one_place;
  if (2 * n_single <= c.n_occupied) return;
  const char* counted = o.ccs_singletons == Singletons::kExclude ? "color consistency is of the rest alone"
                                                                 : "they count as 0, which is perfect";
  warnings.push_back(
      {"color_consistency_sparse",
       fmt::format("{} of the evaluated map's {} voxels of {} m hold a single point or copies of one: {}; a larger "
                   "ccs-voxel says more of so sparse a map",
                   n_single, c.n_occupied, o.ccs_voxel_m, counted)});
}

ColorConsistency consistency_of(const EvaluationOptions& options, const IndexedMap& map) {
  return color_consistency(map, options.ccs_voxel_m, options.ccs_min_points);
}

Json delta_e_fields(const Findings& f) {
  const auto directed = [&](const NearestPairs& pairs) { return delta_e(pairs, f.options.lcr_radius_m); };
  const auto json = [](const DeltaEStats& d) -> Json {
    return {{"mean", json_number(d.mean)}, {"median", json_number(d.median)}, {"p95", json_number(d.p95)}, {"n", d.n}};
  };
  const DeltaEStats e = directed(f.pair.estimate_to_reference());
  const DeltaEStats r = directed(f.pair.reference_to_estimate());
  Json fields{{"value", json_number(0.5 * (e.mean + r.mean))},
              {"parameters", {{"radius_m", f.options.lcr_radius_m}}},
              {"estimate_to_reference", json(e)},
              {"reference_to_estimate", json(r)}};
  add_without_color(fields, f.pair);
  return fields;
}

Json by_range_fields(const Findings& f) {
  constexpr std::array kEdges_m{0.0, 0.05, 0.1, 0.2, 0.5, 1.0};
  Json bins = Json::array();
  for (std::size_t b = 0; b + 1 < kEdges_m.size(); ++b) {
    ColorDistanceOptions range;
    if (b > 0) range.min_distance_m = kEdges_m[b];
    range.max_distance_m = kEdges_m[b + 1];
    const ColorDistance cd = color_distance(f.pair, range);
    bins.push_back({{"lo_m", kEdges_m[b]},
                    {"hi_m", kEdges_m[b + 1]},
                    {"value", json_number(cd.value())},
                    {"estimate_to_reference", json_number(cd.estimate_to_reference.mean)},
                    {"reference_to_estimate", json_number(cd.reference_to_estimate.mean)},
                    {"n_estimate", cd.estimate_to_reference.n},
                    {"n_reference", cd.reference_to_estimate.n}});
  }
  Json fields{{"per_range", bins}};
  add_without_color(fields, f.pair);
  return fields;
}

Json exposure_free_fields(const Findings& f) {
  const ExposureGains gains = exposure_gains(f.pair, f.options.lcr_radius_m);
  ColorDistanceOptions pairs = pairs_that_count(f.options);
  pairs.estimate_gain = gains.gain;
  const ColorDistance cd = color_distance(f.pair, pairs);
  Json parameters = max_distance_parameter(f.options);
  parameters["radius_m"] = f.options.lcr_radius_m;
  Json fields{{"value", json_number(cd.value())},
              {"parameters", parameters},
              {"gains", json_vector(gains.gain)},
              {"n_pairs", gains.n_pairs},
              {"estimate_to_reference", json_number(cd.estimate_to_reference.mean)},
              {"reference_to_estimate", json_number(cd.reference_to_estimate.mean)}};
  add_without_color(fields, f.pair);
  return fields;
}

Json psnr_fields(const Findings& f, std::vector<Warning>& warnings) {
  const ColorPsnr psnr = color_psnr(f.pair);
  const Eigen::Vector3d db = psnr.psnr_db();
  if (std::isinf(db.x())) {
    warnings.push_back({"color_psnr_infinite", "luma is exact: color PSNR is infinite, which is null in JSON"});
  }
  Json fields{{"value", json_number(db.x())},
              {"y", json_number(db.x())},
              {"cb", json_number(db.y())},
              {"cr", json_number(db.z())},
              {"mse",
               {{"estimate_to_reference", json_vector(psnr.mse_estimate_to_reference)},
                {"reference_to_estimate", json_vector(psnr.mse_reference_to_estimate)}}}};
  add_without_color(fields, f.pair);
  return fields;
}

}  // namespace

Json color_consistency_fields(const EvaluationOptions& o, const IndexedMap& map, std::vector<Warning>& warnings) {
  const ColorConsistency consistency = consistency_of(o, map);
  if (o.ccs_singletons == Singletons::kRefuse && consistency.n_singletons > 0) {
    throw UnsupportedError(
        fmt::format("ccs-singletons: {} of the evaluated map's {} voxels of {} m hold a single point; zero or exclude "
                    "says what they count as",
                    consistency.n_singletons, consistency.n_occupied, o.ccs_voxel_m));
  }
  if (consistency.n_voxels(o.ccs_singletons) == 0) {
    warnings.push_back({"color_consistency_no_voxels",
                        fmt::format("no {} m voxel of the evaluated map holds {} points: no color consistency",
                                    o.ccs_voxel_m, o.ccs_min_points)});
  }
  warn_of_singletons(o, consistency, warnings);
  Json fields = consistency_numbers(map, consistency, o.ccs_singletons);
  fields["parameters"] = {
      {"voxel_m", o.ccs_voxel_m}, {"singletons", singletons_name(o.ccs_singletons)}, {"min_points", o.ccs_min_points}};
  return fields;
}

std::vector<MetricRecord> color_records(const Findings& f, std::optional<LocalColorRecall>& recall,
                                        std::vector<Warning>& warnings) {
  std::optional<ColorDistance> cd;
  if (f.selection.contains("color_distance") || f.selection.contains("color_fidelity")) {
    cd = color_distance(f.pair, pairs_that_count(f.options));
  }
  RecordList records(f.selection);
  records.add("color_distance", [&] { return color_distance_fields(f.options, f.pair, *cd, warnings); });
  records.add("color_fidelity", [&] { return fidelity_fields(f.options, *cd, warnings); });
  records.add("local_color_recall", [&] {
    recall = local_color_recall(
        f.pair, {.tau = f.options.lcr_tau, .radius_m = f.options.lcr_radius_m, .curve = f.options.lcr_curve});
    return recall_fields(f.options, f.pair, *recall);
  });
  records.add("color_consistency", [&] {
    Json fields = color_consistency_fields(f.options, f.pair.estimate, warnings);
    const IndexedMap& reference = f.pair.reference;
    fields["reference"] =
        consistency_numbers(reference, consistency_of(f.options, reference), f.options.ccs_singletons);
    return fields;
  });
  records.add("delta_e", [&] { return delta_e_fields(f); });
  records.add("color_distance_by_range", [&] { return by_range_fields(f); });
  records.add("color_distance_exposure_free", [&] { return exposure_free_fields(f); });
  records.add("color_psnr", [&] { return psnr_fields(f, warnings); });
  return records.take();
}

std::vector<MetricRecord> missing_color_records(const MetricSelection& selection) {
  RecordList records(selection);
  for (const MetricInfo& metric : metric_catalog()) {
    if (metric.needs_color) records.add(metric.id, [] { return Json{{"value", nullptr}}; });
  }
  return records.take();
}

}  // namespace cmap
