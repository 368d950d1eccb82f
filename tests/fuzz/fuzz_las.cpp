#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cmap::fuzz::run(cmap::fuzz::read_las_classes, data, size);
  return cmap::fuzz::run(cmap::fuzz::read_las_as_it_is, data, size);
}
