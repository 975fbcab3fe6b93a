// The input is JSON, a byte 0xff, and the binary chunk: the fuzzer need not learn chunk headers.
#include <fuzz/fuzz_support.h>
#include <varifold/base/bytes.h>
#include <varifold/io/gltf.h>
#include <algorithm>
#include <vector>

using namespace varifold;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto input = fuzz::bytes(data, size);
  const auto border = std::find(input.begin(), input.end(), std::byte{0xff});
  const std::vector<std::byte> json(input.begin(), border);
  const std::vector<std::byte> binary(border, input.end());
  std::vector<std::byte> file;
  append_text(file, "glTF");
  append_little(file, std::uint32_t{2});
  append_little(file, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append_little(file, static_cast<std::uint32_t>(json.size()));
  append_text(file, "JSON");
  file.insert(file.end(), json.begin(), json.end());
  append_little(file, static_cast<std::uint32_t>(binary.size()));
  append_text(file, std::string_view("BIN\0", 4));
  file.insert(file.end(), binary.begin(), binary.end());
  fuzz::check(read_gltf(file));
  return 0;
}
