#include <varifold/models/patch_tree/front_bits.h>
#include <varifold/models/patch_tree/front_scan.h>
#include <bit>
#include <cmath>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace varifold::front_scan {

namespace {

using WordWithin = std::uint64_t (*)(std::uint64_t, const float*, const Window&);

#if defined(__x86_64__)

__attribute__((target("avx2"))) std::uint64_t word_within_avx2(std::uint64_t nodes,
                                                               const float* priorities,
                                                               const Window& window) {
  const __m256 above = _mm256_set1_ps(window.above), up_to = _mm256_set1_ps(window.up_to);
  std::uint64_t bits = 0;
  for (std::uint64_t rest = nodes; rest != 0;) {
    const std::uint32_t shift = static_cast<std::uint32_t>(std::countr_zero(rest)) & ~7u;
    rest &= ~(0xffull << shift);
    const __m256 values = _mm256_loadu_ps(priorities + shift);
    const __m256 within = _mm256_and_ps(_mm256_cmp_ps(values, above, _CMP_GT_OQ),
                                        _mm256_cmp_ps(values, up_to, _CMP_LE_OQ));
    bits |= static_cast<std::uint64_t>(_mm256_movemask_ps(within)) << shift;
  }
  return bits & nodes;
}

const WordWithin kWordWithin =
    __builtin_cpu_supports("avx2") != 0 ? word_within_avx2 : word_within_plain;

#else

constexpr WordWithin kWordWithin = word_within_plain;

#endif

}  // namespace

std::uint64_t word_within_plain(std::uint64_t nodes, const float* priorities,
                                const Window& window) {
  std::uint64_t bits = 0;
  front_bits::for_each_of_word(nodes, 0, [&](std::uint32_t i) {
    const bool is_within = (priorities[i] > window.above) & (priorities[i] <= window.up_to);
    bits |= static_cast<std::uint64_t>(is_within) << i;
  });
  return bits;
}

std::uint64_t word_within(std::uint64_t nodes, const float* priorities, const Window& window) {
  return kWordWithin(nodes, priorities, window);
}

void find_above(const Among& among, float tolerance, std::span<std::uint64_t> above) {
  const Window window{tolerance, HUGE_VALF};
  front_bits::for_each(among.words, [&](std::uint32_t word) {
    above[word] = kWordWithin(among.nodes[word], &among.priorities[std::size_t{64} * word], window);
  });
}

void collect(const Among& among, std::span<const std::uint64_t> except, const Window& window,
             std::vector<std::uint32_t>& found) {
  front_bits::for_each(among.words, [&](std::uint32_t word) {
    const std::uint64_t left = among.nodes[word] & ~(except.empty() ? 0 : except[word]);
    const std::uint64_t within =
        kWordWithin(left, &among.priorities[std::size_t{64} * word], window);
    front_bits::for_each_of_word(within, word, [&](std::uint32_t node) { found.push_back(node); });
  });
}

}  // namespace varifold::front_scan
