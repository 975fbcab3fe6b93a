// Points of the original surface, kept with the faces or curves that they are attached to.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/block_pool.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// A point of the original, and what it contributes to the energy where it is attached.
struct EnergySample {
  Vec3 position{0};                  ///< unit scale
  float energy = 0;                  ///< squared distance, and squared error of its attributes
  std::uint32_t attributes = kNone;  ///< its row of attribute values; kNone: has none
};

/// The samples of every owner (a face, an edge) side by side in one flat array; room for at least
/// `kSmallest` where there are any.
template <class Sample, std::uint32_t kSmallest>
class SamplesOfOwners {
 public:
  explicit SamplesOfOwners(std::uint32_t owners = 0) : owners_(owners) {}

  [[nodiscard]] std::span<const Sample> of(std::uint32_t owner) const {
    return {pool_.at(owners_[owner].offset), owners_[owner].size};
  }

  /// What of() and clear() will read: first where the samples of an owner are, later these.
  void prefetch_owner(std::uint32_t owner) const { __builtin_prefetch(&owners_[owner]); }
  void prefetch(std::uint32_t owner) const {
    if (owners_[owner].size > 0) __builtin_prefetch(pool_.at(owners_[owner].offset));
  }

  /// Amortised O(1); spans of of() do not outlive it.
  void add(std::uint32_t owner, const Sample& sample) {
    Owner& block = owners_[owner];
    if (block.size == 0) {
      block.offset = pool_.allocate(1);
    } else if (block.size == Pool::capacity(block.size)) {
      const std::uint32_t larger = pool_.allocate(block.size + 1);
      std::copy_n(pool_.at(block.offset), block.size, pool_.at(larger));
      pool_.release(block.offset, block.size);
      block.offset = larger;
    }
    pool_.at(block.offset)[block.size++] = sample;
    ++live_;
  }

  /// Moves everything together where most of the memory lies free: as samples gather on fewer
  /// owners, blocks of sizes that nobody needs any more are left. Amortised O(1) a sample.
  void tidy() {
    // What is moved together is at most so many times what lives; until twice that has gathered
    // again, or half of it has gone, nothing is moved.
    constexpr std::size_t kMostRoom = std::max(2u, kSmallest);
    if (pool_.size() <= kMinTidyEntries + 2 * kMostRoom * live_) return;
    Pool tidied;
    for (Owner& block : owners_) {
      if (block.size == 0) continue;
      const std::uint32_t offset = tidied.allocate(block.size);
      std::copy_n(pool_.at(block.offset), block.size, tidied.at(offset));
      block.offset = offset;
    }
    pool_ = std::move(tidied);
  }

  void clear(std::uint32_t owner) {
    Owner& block = owners_[owner];
    if (block.size > 0) pool_.release(block.offset, block.size);
    live_ -= block.size;
    block = {};
  }

  /// A new owner without samples; its number.
  std::uint32_t add_owner() {
    owners_.emplace_back();
    return static_cast<std::uint32_t>(owners_.size() - 1);
  }

  [[nodiscard]] std::size_t bytes() const {
    return pool_.bytes() + owners_.capacity() * sizeof(Owner);
  }

 private:
  using Pool = BlockPool<Sample, kSmallest>;
  struct Owner {
    std::uint32_t offset = 0, size = 0;
  };
  static constexpr std::size_t kMinTidyEntries = 1 << 12;
  std::vector<Owner> owners_;
  Pool pool_;
  std::size_t live_ = 0;  // samples of all owners
};

using SampleBlocks = SamplesOfOwners<EnergySample, 1>;

}  // namespace varifold
