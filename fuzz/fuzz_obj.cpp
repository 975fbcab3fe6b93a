#include <fuzz/fuzz_support.h>
#include <varifold/io/obj.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  varifold::fuzz::check(varifold::read_obj(varifold::fuzz::bytes(data, size)));
  return 0;
}
