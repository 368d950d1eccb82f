#pragma once

#include <functional>

#include "cmap/io/capture.hpp"

namespace cmap {

/// Reads a part of a capture, which is the file or folder `name`, as far as it is wanted. What is wrong with one that
/// only may be there are warnings.
void read_part(Capture& capture, const char* name, Want want, const Faults& faults,
               const std::function<void(const Faults&)>& read);

}  // namespace cmap
