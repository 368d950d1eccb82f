#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cmap::fuzz::try_recorded_message(std::as_bytes(std::span(data, size)));
  return 0;
}
