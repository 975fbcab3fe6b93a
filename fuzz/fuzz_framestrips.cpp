#include <fuzz/fuzz_model.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  varifold::fuzz::check_model<varifold::FrameStrips>(varifold::fuzz::bytes(data, size));
  return 0;
}
