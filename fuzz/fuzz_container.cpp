// The checksums of the input are made right, as far as possible, so that what is behind them is
// reached; then the whole file and the file in two pieces must agree.
#include <fuzz/fuzz_support.h>
#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <varifold/io/container.h>
#include <varifold/io/container_stream.h>
#include <algorithm>
#include <vector>

using namespace varifold;

namespace {

void mend_checksums(std::vector<std::byte>& file) {
  const auto head =
      container::head_size(std::span(file).first(std::min<std::size_t>(file.size(), 32)));
  if (!head || *head > file.size()) return;
  const std::size_t end = *head - 8;
  for (std::size_t at = 32; at < end; at += 40) {
    const auto offset = load<std::uint64_t>(file.data() + at + 8);
    const auto size = load<std::uint64_t>(file.data() + at + 16);
    if (offset > file.size() || size > file.size() - offset) continue;
    store_little(file.data() + at + 32, checksum(std::span(file).subspan(offset, size)));
  }
  store_little(file.data() + end, checksum(std::span(file).first(end)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto input = fuzz::bytes(data, size);
  std::vector<std::byte> file(input.begin(), input.end());
  if (size > 0 && file.back() != std::byte{0xff}) mend_checksums(file);

  auto whole = Container::parse(file);
  const bool is_good = whole && whole->verify();
  ContainerStream stream;
  const std::size_t half = size / 2;
  const bool is_streamed = stream.push(std::span(file).first(half)) &&
                           stream.push(std::span(file).subspan(half)) && stream.finish();
  // Only zstd windows beyond what streams allow may make a difference.
  fuzz::require(is_good || !is_streamed);
  if (!is_streamed) return 0;
  for (std::size_t i = 0; i < stream.table().chunks.size(); ++i) {
    const auto found = whole->find(stream.table().chunks[i].tag);
    const auto streamed = stream.bytes(i);
    fuzz::require(std::equal(found->begin(), found->end(), streamed.begin(), streamed.end()));
  }
  return 0;
}
