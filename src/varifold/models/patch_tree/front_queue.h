// A queue of nodes by priority, the greatest first.
//
// Based on: [Birkholz2007] section 4 (the queue of patches that may be split).
// Differs: buckets on the leading bits of the priorities in place of a heap; the order is exact.
#pragma once

#include <varifold/base/math.h>
#include <varifold/models/patch_tree/front_bits.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Orders nodes by priority, then by number: of equal ones the smaller number is greater. The bits
/// of numbers that are not negative have the order of the numbers.
using FrontKey = std::uint64_t;
[[nodiscard]] inline FrontKey front_key(float priority, std::uint32_t node) {
  return static_cast<FrontKey>(std::bit_cast<std::uint32_t>(priority)) << 32u | ~node;
}
[[nodiscard]] inline std::uint32_t node_of(FrontKey key) {
  return ~static_cast<std::uint32_t>(key);
}

/// Buckets of 1/256 octave are lists; the highest one is a heap while it is emptied, so that the
/// order is exact at the cost of small heaps. Priorities below 2^-40 and from 2^24 on share a
/// bucket. Allocates only where a bucket holds more nodes than any before.
class FrontQueue {
 public:
  explicit FrontQueue(std::uint32_t nodes) : heads_(kBuckets, kNone), next_(nodes), keys_(nodes) {}

  /// A node that is not in the queue; its priority is neither negative nor NaN. In any order, but
  /// quick where it is not above the one that was popped last.
  void push(float priority, std::uint32_t node) {
    const FrontKey key = front_key(priority, node);
    const std::uint32_t bucket = bucket_of(key);
    ++size_;
    if (bucket >= open_bucket_) {
      open_.push_back(key);
      std::push_heap(open_.begin(), open_.end());
      return;
    }
    keys_[node] = static_cast<std::uint32_t>(key >> 32u);
    next_[node] = heads_[bucket];
    heads_[bucket] = node;
    front_bits::add(filled_, bucket);
    front_bits::add(filled_words_, bucket / 64);
  }

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  /// The greatest one. Not empty.
  std::uint32_t pop() {
    if (open_.empty()) open_highest();
    std::pop_heap(open_.begin(), open_.end());
    const std::uint32_t node = node_of(open_.back());
    open_.pop_back();
    --size_;
    return node;
  }
  void clear() {
    front_bits::for_each(filled_words_, [&](std::uint32_t word) {
      front_bits::for_each_of_word(filled_[word], word,
                                   [&](std::uint32_t bucket) { heads_[bucket] = kNone; });
      filled_[word] = 0;
    });
    filled_words_.fill(0);
    open_.clear();
    open_bucket_ = kBuckets;
    size_ = 0;
  }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(*this) + (heads_.size() + next_.size() + keys_.size()) * sizeof(std::uint32_t) +
           open_.capacity() * sizeof(FrontKey);
  }

 private:
  static constexpr std::uint32_t kBucketsPerOctave = 256, kBuckets = 64 * kBucketsPerOctave;
  static constexpr std::uint32_t kLowest = (127 - 40) * kBucketsPerOctave;

  [[nodiscard]] static std::uint32_t bucket_of(FrontKey key) {
    const auto bucket = static_cast<std::uint32_t>(key >> (32u + 23u - 8u));
    return std::clamp(bucket, kLowest, kLowest + kBuckets - 1) - kLowest;
  }

  void open_highest() {
    std::size_t i = filled_words_.size() - 1;
    while (filled_words_[i] == 0) --i;
    const auto word = static_cast<std::uint32_t>(
        64 * i + 63 - static_cast<std::size_t>(std::countl_zero(filled_words_[i])));
    open_bucket_ = 64 * word + 63 - static_cast<std::uint32_t>(std::countl_zero(filled_[word]));
    for (std::uint32_t node = heads_[open_bucket_]; node != kNone; node = next_[node])
      open_.push_back(static_cast<FrontKey>(keys_[node]) << 32u | ~node);
    std::make_heap(open_.begin(), open_.end());
    heads_[open_bucket_] = kNone;
    front_bits::remove(filled_, open_bucket_);
    if (filled_[word] == 0) front_bits::remove(filled_words_, word);
  }

  std::vector<std::uint32_t> heads_, next_, keys_;  // per bucket; per node: the rest of its list
  std::array<std::uint64_t, kBuckets / 64> filled_{};
  std::array<std::uint64_t, kBuckets / 4096> filled_words_{};
  std::vector<FrontKey> open_;
  std::uint32_t open_bucket_ = kBuckets, size_ = 0;
};

}  // namespace varifold
