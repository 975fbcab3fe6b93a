#include <varifold/models/vdpm/key_scan.h>

#include <bit>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace varifold {

namespace {

// Writes the keys from `first` on that are due behind `end`; returns the new end.
std::uint32_t* find_rest(std::span<const float> keys, const Odometers& odometers, std::size_t first,
                         std::uint32_t* end) {
  for (std::size_t i = first; i < keys.size(); ++i) {
    *end = static_cast<std::uint32_t>(i);
    end += odometers.is_due(keys[i]) ? 1 : 0;
  }
  return end;
}

// Room for all keys and one that is written in vain.
std::uint32_t* make_room(std::span<const float> keys, std::vector<std::uint32_t>& room) {
  if (room.size() <= keys.size()) room.resize(keys.size() + keys.size() / 2 + 1);
  return room.data();
}

}  // namespace

std::span<const std::uint32_t> find_due_keys_plain(std::span<const float> keys,
                                                   const Odometers& odometers,
                                                   std::vector<std::uint32_t>& room) {
  std::uint32_t* begin = make_room(keys, room);
  return {begin, find_rest(keys, odometers, 0, begin)};
}

#if defined(__x86_64__)

namespace {

constexpr std::size_t kWord = 64;

// Eight keys at a time: the last bits of each choose its odometer. Sixty-four answers are read off
// together, since few of them are yes.
__attribute__((target("avx2,bmi"))) std::span<const std::uint32_t> find_due_keys_avx2(
    std::span<const float> keys, const Odometers& odometers, std::vector<std::uint32_t>& room) {
  std::uint32_t* const begin = make_room(keys, room);
  std::uint32_t* end = begin;
  const __m256 now = _mm256_loadu_ps(odometers.now().data());
  std::size_t i = 0;
  for (; i + kWord <= keys.size(); i += kWord) {
    std::uint64_t yes = 0;
    for (std::size_t j = 0; j < kWord; j += 8) {
      const __m256 key = _mm256_loadu_ps(keys.data() + i + j);
      // The permutation takes the last three bits of each lane and leaves the others alone.
      const __m256 odometer = _mm256_permutevar8x32_ps(now, _mm256_castps_si256(key));
      const int mask = _mm256_movemask_ps(_mm256_cmp_ps(odometer, key, _CMP_GE_OQ));
      yes |= std::uint64_t{static_cast<unsigned>(mask)} << j;
    }
    for (; yes != 0; yes &= yes - 1)
      *end++ = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(std::countr_zero(yes));
  }
  return {begin, find_rest(keys, odometers, i, end)};
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

}  // namespace

std::span<const std::uint32_t> find_due_keys(std::span<const float> keys,
                                             const Odometers& odometers,
                                             std::vector<std::uint32_t>& room) {
  return kHasAvx2 ? find_due_keys_avx2(keys, odometers, room)
                  : find_due_keys_plain(keys, odometers, room);
}

#else

std::span<const std::uint32_t> find_due_keys(std::span<const float> keys,
                                             const Odometers& odometers,
                                             std::vector<std::uint32_t>& room) {
  return find_due_keys_plain(keys, odometers, room);
}

#endif

}  // namespace varifold
