#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "cmap/core/enum_names.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

namespace cmap {

/// What tools take beside the options of metrics.
struct PeerOptions {
  double tanks_and_temples_tau_m = 0.0;
  std::optional<Box3d> crop;  ///< reference frame
};

/// Another tool whose numbers `--as` gives, by its own names: a source of its name in lib/peers/ defines one in
/// namespace cmap::peers, and its name in the module's CMakeLists.txt puts it into peer_tools().
struct PeerTool {
  std::string_view name;
  /// Of a pair; fields of the inputs that it needs are made where they are missing.
  Record (*record)(MetricInputs&, const PeerOptions&);
  /// Warning where it needs a color at every point of both maps and there is not: then it has no record.
  std::string_view no_color_id = {};
  std::string_view no_color = {};
  bool reads_gaussians = false;  ///< of the voxels of the average Wasserstein distance
};

/// All of them, in the order of --help.
std::span<const PeerTool* const> peer_tools();
/// By their names.
const EnumNames<const PeerTool*>& peer_tool_names();
/// Nullptr if there is none of that name.
const PeerTool* peer_tool(std::string_view name);

}  // namespace cmap
