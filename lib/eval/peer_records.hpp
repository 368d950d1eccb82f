#pragma once

#include "eval/metric_records.hpp"

namespace cmap {

/// What the tools of `--as` would print on this pair, by tool; null if none is asked for. Tools that need color where a
/// map has none get a null, with a warning.
nlohmann::ordered_json peer_records(const Findings& findings, std::vector<Warning>& warnings);

}  // namespace cmap
