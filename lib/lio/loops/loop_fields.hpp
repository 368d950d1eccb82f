#pragma once

#include "cmap/core/options.hpp"
#include "cmap/lio/loop_options.hpp"

namespace cmap {

/// The options of loops by name, as loops.json has them.
OptionFields option_fields(LoopOptions& options);

}  // namespace cmap
