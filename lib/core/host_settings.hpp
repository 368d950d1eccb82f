#pragma once

#include "cmap/core/simd.hpp"

namespace cmap {

struct ExecutionState;

// What a loaded module, which has a copy of this library, takes from the program in place of its own.

void take_execution_from(ExecutionState*& (*current)());
/// Before simd_level() is called.
void take_simd_level(SimdLevel level);

}  // namespace cmap
