#include "captures/capture_part.hpp"

#include <fmt/format.h>

#include "cmap/io/file_place.hpp"

namespace cmap {

void read_part(Capture& capture, const char* name, Want want, const Faults& faults,
               const std::function<void(const Faults&)>& read) {
  if (want == Want::kYes) {
    faults.attempt([&] { read(faults); });
  } else if (want == Want::kIfUsable && is_there(capture.folder / name)) {
    std::vector<std::string> found;
    const Faults all(found);
    all.attempt([&] { read(faults.goes_on() ? all : Faults()); });
    for (const std::string& fault : found) {
      capture.warnings.push_back({"part_left_out", fmt::format("{}; the run goes on without", fault)});
    }
  }
}

}  // namespace cmap
