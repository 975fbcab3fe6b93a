// A monotone priority queue of vertices: buckets on the leading bits of a float cost.
#pragma once

#include <varifold/base/math.h>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace varifold {

/// Buckets hold costs that share sign, exponent and six bits of mantissa, so the order is exact
/// to 1.5 %. Within a bucket the last in is the first out. Cost never goes down: what is pushed
/// below the current bucket goes into the current one.
class BucketQueue {
 public:
  static constexpr int kMantissaBits = 6;
  static constexpr std::uint32_t kBucketsPerOctave = 1u << kMantissaBits;
  static constexpr std::uint32_t kBucketCount = 256u * kBucketsPerOctave;

  BucketQueue() : heads_(kBucketCount, kNone) {}

  /// `cost` >= 0 and not NaN.
  [[nodiscard]] static std::uint32_t bucket_of(float cost) {
    return std::bit_cast<std::uint32_t>(cost) >> (23 - kMantissaBits);
  }

  /// The least cost that falls into a bucket.
  [[nodiscard]] static float least_cost(std::uint32_t bucket) {
    return std::bit_cast<float>(bucket << (23 - kMantissaBits));
  }

  void push(std::uint32_t vertex, std::uint32_t bucket) {
    if (bucket < current_) bucket = current_;
    std::uint32_t head = heads_[bucket];
    if (head == kNone || chunks_[head].size == kChunkCapacity) head = add_chunk(bucket);
    Chunk& chunk = chunks_[head];
    chunk.vertices[chunk.size++] = vertex;
    ++in_octave_[bucket >> kMantissaBits];
    ++size_;
  }

  /// The next vertex from a bucket below `limit`, or kNone. `prefetch.later(v)` is called with a
  /// vertex that will come up in a while, `prefetch.soon(v)` with one that comes up soon.
  template <class Prefetch>
  [[nodiscard]] std::uint32_t pop(std::uint32_t limit, const Prefetch& prefetch) {
    while (current_ < limit) {
      const std::uint32_t head = heads_[current_];
      if (head == kNone) {
        ++current_;
        continue;
      }
      Chunk& chunk = chunks_[head];
      const std::uint32_t vertex = chunk.vertices[--chunk.size];
      if (const std::uint32_t next = upcoming(chunk, kLater); next != kNone) prefetch.later(next);
      if (const std::uint32_t next = upcoming(chunk, kSoon); next != kNone) prefetch.soon(next);
      if (chunk.size == 0) drop_chunk(head);
      --in_octave_[current_ >> kMantissaBits];
      --size_;
      return vertex;
    }
    return kNone;
  }

  /// Lets an empty queue begin at the lowest bucket again.
  void restart() { current_ = 0; }

  /// The bucket that the last pop looked at.
  [[nodiscard]] std::uint32_t current() const { return current_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// The lowest bucket that holds a vertex, or kBucketCount.
  [[nodiscard]] std::uint32_t lowest() const {
    std::uint32_t bucket = current_;
    while (bucket < kBucketCount && heads_[bucket] == kNone) ++bucket;
    return bucket;
  }

  /// Entries in buckets below `limit`. O(octaves + chunks of the last one).
  [[nodiscard]] std::size_t count_below(std::uint32_t limit) const {
    std::size_t count = 0;
    for (std::uint32_t octave = 0; octave < limit >> kMantissaBits; ++octave)
      count += in_octave_[octave];
    for (std::uint32_t bucket = limit & ~(kBucketsPerOctave - 1); bucket < limit; ++bucket)
      for (std::uint32_t i = heads_[bucket]; i != kNone; i = chunks_[i].next)
        count += chunks_[i].size;
    return count;
  }

  /// Moves the entries of one bucket to another queue. O(entries + bucket).
  void give(std::uint32_t bucket, BucketQueue& other) {
    for (std::uint32_t i = heads_[bucket]; i != kNone;) {
      for (std::uint32_t k = 0; k < chunks_[i].size; ++k)
        other.push(chunks_[i].vertices[k], bucket);
      size_ -= chunks_[i].size;
      in_octave_[bucket >> kMantissaBits] -= chunks_[i].size;
      const std::uint32_t next = chunks_[i].next;
      chunks_[i].next = free_;
      free_ = i;
      i = next;
    }
    heads_[bucket] = kNone;
  }

  /// Takes all entries of `other`, which is empty afterwards.
  void take(BucketQueue& other) {
    for (std::uint32_t bucket = 0; bucket < kBucketCount; ++bucket) {
      for (std::uint32_t i = other.heads_[bucket]; i != kNone; i = other.chunks_[i].next)
        for (std::uint32_t k = 0; k < other.chunks_[i].size; ++k)
          push(other.chunks_[i].vertices[k], bucket);
    }
    other = BucketQueue();
  }

  [[nodiscard]] std::size_t bytes() const {
    return heads_.capacity() * sizeof(heads_[0]) + chunks_.capacity() * sizeof(Chunk);
  }

 private:
  static constexpr std::uint32_t kChunkCapacity = 14;
  static constexpr std::uint32_t kLater = 7;
  static constexpr std::uint32_t kSoon = 3;
  struct alignas(64) Chunk {
    std::uint32_t vertices[kChunkCapacity];
    std::uint32_t size;
    std::uint32_t next;
  };

  // The entry that so many pops will reach, if it is in this chunk or the next one of its bucket;
  // chunks behind the head are full.
  [[nodiscard]] std::uint32_t upcoming(const Chunk& chunk, std::uint32_t pops) const {
    if (chunk.size >= pops) return chunk.vertices[chunk.size - pops];
    if (chunk.next == kNone) return kNone;
    return chunks_[chunk.next].vertices[kChunkCapacity + chunk.size - pops];
  }

  std::uint32_t add_chunk(std::uint32_t bucket) {
    std::uint32_t id = free_;
    if (id == kNone) {
      id = static_cast<std::uint32_t>(chunks_.size());
      chunks_.emplace_back();
    } else {
      free_ = chunks_[id].next;
    }
    chunks_[id].size = 0;
    chunks_[id].next = heads_[bucket];
    return heads_[bucket] = id;
  }

  void drop_chunk(std::uint32_t head) {
    heads_[current_] = chunks_[head].next;
    chunks_[head].next = free_;
    free_ = head;
    // The next chunk of the bucket comes up now.
    if (heads_[current_] != kNone) __builtin_prefetch(&chunks_[heads_[current_]]);
  }

  std::vector<std::uint32_t> heads_;
  std::vector<Chunk> chunks_;
  std::array<std::uint32_t, kBucketCount / kBucketsPerOctave> in_octave_{};  // entries
  std::uint32_t free_ = kNone;
  std::uint32_t current_ = 0;
  std::size_t size_ = 0;
};

}  // namespace varifold
