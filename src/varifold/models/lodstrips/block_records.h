// The bytes of the changes of blocks.
//
// A step is a list of groups, each of one block. A group is a word of three or four bytes: the
// number of the block in the low bits, and in the eight high ones how many slots are repeated (two
// bits), how many are set (three bits) and what else there is (three bits, Rest); then a byte per
// slot that is repeated, a byte per slot that is set; then the rest. They are done in this order.
// For kMixed the rest is a byte with its size and operations of a byte or more: a kind in the two
// low bits, and a slot, or for kExtended one of Extended, followed by what that needs. The vertex
// that a group speaks of is the first new one of the step, until kAdvance.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace varifold::blocks {

enum Kind : std::uint8_t {
  kSet,           ///< the slot gets the new vertex; before it had its target
  kDuplicate,     ///< the slot and the next are repeated
  kInsertTarget,  ///< the target of the new vertex comes before the slot
  kExtended
};

/// What follows: s a slot, n a number of slots, each a byte; v a vertex, four bytes.
enum Extended : std::uint8_t {
  kAdvance,        ///< n: the new vertex is that many further on
  kOpenCopy,       ///< n, s: a strip of one triangle in order n (BlockChange), of the new
                   ///< vertex, its target and a copy of slot s
  kOpenValue,      ///< n, v: the same with v
  kInsertCopy,     ///< s, s: before the first, a copy of the second
  kInsertRestart,  ///< s
  kInsertValue,    ///< s, v
  kRotateOne,      ///< s: three slots from s on move left by one
  kRotateTwo,      ///< s
  kReverse,        ///< s, n
  kSplitBetween,   ///< s: from s on to the next new block; the restart before goes
  kSplitInside,    ///< s: the same; two slots stay as well
  kAssignCopy,     ///< s, s: the first, a copy of the next slot, gets that of the second
  kAssignValue,    ///< s, v
  kNewBlock,       ///< the next new block is in use
  kFirst,          ///< the new vertex is the first of the step again
  kExtendedCount
};

/// Bytes after the first one.
inline constexpr std::array<std::uint8_t, kExtendedCount> kPayload = {1, 2, 5, 2, 1, 5, 1, 1,
                                                                      2, 1, 1, 2, 5, 0, 0};

[[nodiscard]] inline std::uint32_t load_value(const std::uint8_t* at) {
  std::uint32_t value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

enum Rest : std::uint8_t {
  kNothing,
  kTargetInserted,  ///< a byte: the slot before which the target of the new vertex comes
  kVertexInserted,  ///< a byte: the same, and then the slot is set
  kOpened,          ///< a byte: kOpenCopy with the order, less than four, in the two low bits
  kOpenedHigh,      ///< the same for the orders from four on
  kMixed            ///< a byte: the size in bytes of the operations that follow
};

/// How the first word of a group is read.
struct WordFormat {
  static constexpr std::uint32_t kHighBits = 8;
  static constexpr std::uint32_t kMostDuplicates = 3, kMostSets = 7;
  std::uint32_t bytes;  ///< 3 or 4
  std::uint32_t id_bits;
  constexpr explicit WordFormat(std::uint32_t word_bytes)
      : bytes(word_bytes), id_bits(8 * word_bytes - kHighBits) {}

  [[nodiscard]] std::uint32_t block_limit() const { return 1u << id_bits; }
};

struct Group {
  std::uint32_t block, duplicates, sets, rest;
  Group(const std::uint8_t* at, const WordFormat& format) {
    const std::uint32_t word = load_value(at);
    block = word & (format.block_limit() - 1);
    const std::uint32_t high = word >> format.id_bits;
    duplicates = high & 3u;
    sets = (high >> 2u) & 7u;
    rest = (high >> 5u) & 7u;
  }
  /// Where the bytes of the group end; `slots` is what follows its word.
  [[nodiscard]] const std::uint8_t* end(const std::uint8_t* slots) const {
    slots += duplicates + sets;
    return slots + (rest == kMixed ? 1 + *slots : rest == kNothing ? 0 : 1);
  }
};

}  // namespace varifold::blocks
