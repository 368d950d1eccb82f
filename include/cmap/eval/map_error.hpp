#pragma once

#include <string>

#include "cmap/core/error.hpp"

namespace cmap {

/// What is wrong with the points of one map of an evaluation; whoever knows its file can name it in place of "the
/// estimate". evaluate() throws it where single points stretch a map, or its unit does, so far that voxels of the
/// default size cannot be counted.
struct MapError : InputError {
  MapError(const std::string& which_map, const std::string& why)
      : InputError("the " + which_map + ": " + why), which(which_map), reason(why) {}
  std::string which;  ///< "reference", "estimate", "map"
  std::string reason;
};

}  // namespace cmap
