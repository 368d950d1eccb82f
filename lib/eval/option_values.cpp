#include "option_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/peers/peer_tool.hpp"

namespace cmap {

NameListValue metric_names_value(std::vector<std::string>& metrics) {
  const auto get = [&metrics] { return metrics.empty() ? std::vector<std::string>{"default"} : metrics; };
  const auto set = [&metrics](const std::vector<std::string>& names) {
    if (names.empty()) throw UsageError("metrics: [] names no metric");
    EvaluationOptions checked;
    checked.metrics = names;
    select_metrics(checked);
    metrics = names;
  };
  return {get, set};
}

NameListValue tools_value(std::vector<const PeerTool*>& tools) {
  const auto get = [&tools] {
    std::vector<std::string> names;
    for (const PeerTool* tool : tools) names.emplace_back(tool->name);
    return names;
  };
  const auto set = [&tools](const std::vector<std::string>& names) {
    std::vector<const PeerTool*> found;
    for (const std::string& name : names) {
      found.push_back(peer_tool(name));
      if (found.back() != nullptr) continue;
      const std::vector<std::string> known = words_of(peer_tool_names());
      throw UsageError(fmt::format("as: \"{}\" is unknown{}; tools are {}", name, did_you_mean(name, known),
                                   fmt::join(known, ", ")));
    }
    tools = std::move(found);
  };
  return {get, set};
}

NumberListValue thresholds_value(std::vector<double>& thresholds_m) {
  const auto get = [&thresholds_m] { return std::optional(thresholds_m); };
  const auto set = [&thresholds_m](const std::optional<std::vector<double>>& list) -> std::string {
    for (const double v : *list) {
      if (!(v > 0.0)) return "must be above 0 throughout";
      if (std::ranges::count(*list, v) > 1) return "names a threshold twice";
    }
    thresholds_m = *list;
    return "";
  };
  return {get, set};
}

NumberListValue crop_value(std::optional<Box3d>& crop) {
  const auto get = [&crop]() -> std::optional<std::vector<double>> {
    if (!crop) return std::nullopt;
    return std::vector<double>{crop->min.x(), crop->min.y(), crop->min.z(),
                               crop->max.x(), crop->max.y(), crop->max.z()};
  };
  const auto set = [&crop](const std::optional<std::vector<double>>& v) -> std::string {
    if (v && v->size() != 6) return "is not xmin,ymin,zmin,xmax,ymax,zmax";
    const auto box =
        v ? std::optional(Box3d{{v->at(0), v->at(1), v->at(2)}, {v->at(3), v->at(4), v->at(5)}}) : std::nullopt;
    if (box && (box->max.array() < box->min.array()).any()) return "has a maximum below its minimum";
    crop = box;
    return "";
  };
  return {get, set, /*can_be_unset=*/true};
}

}  // namespace cmap
