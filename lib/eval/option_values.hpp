#pragma once

#include "cmap/eval/options.hpp"

/// Options of an evaluation whose values have rules of their own.
namespace cmap {

/// Names of groups and metrics; "default" for none.
NameListValue metric_names_value(std::vector<std::string>& metrics);

/// Other tools by their names.
NameListValue tools_value(std::vector<const PeerTool*>& tools);

/// Above 0 and each only once.
NumberListValue thresholds_value(std::vector<double>& thresholds_m);

/// xmin, ymin, zmin, xmax, ymax, zmax, or nothing.
NumberListValue crop_value(std::optional<Box3d>& crop);

}  // namespace cmap
