#include "cmap/align/trajectory_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cmap {
namespace {

nlohmann::ordered_json offset_json(const std::optional<TimeOffset>& offset) {
  if (!offset) return nullptr;
  return {{"offset_s", offset->offset_s},
          {"standard_error_s", offset->standard_error_s},
          {"rmse_m", offset->rmse_m},
          {"n_pairs", offset->n_pairs}};
}

}  // namespace

nlohmann::ordered_json trajectory_json(const TrajectoryAlignment& found) {
  nlohmann::ordered_json json{{"ate", nlohmann::ordered_json::array()}, {"misfit_times_s", found.misfit_times_s}};
  for (const TrajectoryError& error : found.errors) {
    json["ate"].push_back({{"pairing", name_of(error.pairing, time_pairing_names())},
                           {"n_pairs", error.n_pairs},
                           {"rmse_m", error.rmse_m}});
  }
  json["time_offset_s"] = found.time_offset_s;
  json["found_time_offset"] = offset_json(found.found_time_offset);
  return json;
}

std::string trajectory_lines(const TrajectoryAlignment& found) {
  std::string lines;
  for (const TrajectoryError& error : found.errors) {
    lines += fmt::format("ATE         {:.10g} m   all {} pairs, {}\n", error.rmse_m, error.n_pairs,
                         name_of(error.pairing, time_pairing_names()));
  }
  const auto& offset = found.found_time_offset;
  const bool is_estimate = offset && offset->offset_s == found.time_offset_s;
  if (found.time_offset_s == 0.0 && !is_estimate) return lines;
  lines += fmt::format("time offset {:.6f} s   added to SRC's times", found.time_offset_s);
  lines += is_estimate ? fmt::format(", standard error {:.2g} s\n", offset->standard_error_s) : "\n";
  return lines;
}

}  // namespace cmap
