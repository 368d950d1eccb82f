#include "cmap/metrics/point_spacing.hpp"
#include "eval/json_number.hpp"
#include "eval/metric_records.hpp"
#include "eval/record_list.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json spacing_numbers(const PointSpacing& spacing) {
  return {{"value", json_number(spacing.median_m)},
          {"mean", json_number(spacing.mean_m)},
          {"n", spacing.n},
          {"n_copies", spacing.n_copies}};
}

}  // namespace

Json point_spacing_fields(const IndexedMap& map, std::vector<Warning>& warnings) {
  const PointSpacing spacing = point_spacing(map.index);
  if (spacing.n < 2) warnings.push_back({"point_spacing_one_place", "all points are at one place: no point spacing"});
  return spacing_numbers(spacing);
}

std::vector<MetricRecord> density_records(const Findings& f, std::vector<Warning>& warnings) {
  RecordList records(f.selection);
  records.add("point_spacing", [&] {
    Json fields = point_spacing_fields(f.pair.estimate, warnings);
    fields["reference"] = spacing_numbers(point_spacing(f.pair.reference.index));
    return fields;
  });
  return records.take();
}

}  // namespace cmap
