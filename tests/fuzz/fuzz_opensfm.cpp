#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return cmap::fuzz::run(cmap::read_opensfm, data, size);
}
