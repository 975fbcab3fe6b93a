#include <fuzz/fuzz_support.h>
#include <varifold/io/stl.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  varifold::fuzz::check(varifold::read_stl(varifold::fuzz::bytes(data, size)));
  return 0;
}
