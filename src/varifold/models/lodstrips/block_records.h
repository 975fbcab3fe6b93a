// The bytes of the changes of blocks.
//
// A step is a list of groups: the number of a block, its highest bit set in the last group; in all
// others a byte with the size of the operations; the operations. An operation is a byte: a kind in
// the two low bits, and a slot, or for kExtended one of Extended, followed by what that needs.
// The vertex that operations speak of is the first new one of the step, until kAdvance.
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
  kAdvance,            ///< n: the new vertex is that many further on
  kOpenNewCopy,        ///< s: a strip of new vertex, target, copy of slot s
  kOpenTargetCopy,     ///< s: the same with the first two exchanged
  kOpenNewValue,       ///< v instead of a copy
  kOpenTargetValue,    ///< v
  kInsertCopy,         ///< s, s: before the first, a copy of the second
  kInsertRestart,      ///< s
  kInsertValue,        ///< s, v
  kRotateOne,          ///< s: three slots from s on move left by one
  kRotateTwo,          ///< s
  kReverse,            ///< s, n
  kSplitBetween,       ///< s: from s on to the next new block; the restart before goes
  kSplitInside,        ///< s: the same; two slots stay as well
  kAssignCopy,         ///< s, s: the first, a copy of the next slot, gets that of the second
  kAssignValue,        ///< s, v
  kNewBlock,           ///< the next new block is in use
  kFirst,              ///< the new vertex is the first of the step again
  kExtendedCount
};

/// Bytes after the first one.
inline constexpr std::array<std::uint8_t, kExtendedCount> kPayload = {1, 1, 1, 4, 4, 2, 1, 5,
                                                                      1, 1, 2, 1, 1, 2, 5, 0, 0};

[[nodiscard]] inline std::uint32_t load_value(const std::uint8_t* at) {
  std::uint32_t value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

/// The block's number in the first bytes of a group, with the bit of the last group.
[[nodiscard]] inline std::uint32_t load_id(const std::uint8_t* at, std::uint32_t id_bytes) {
  return load_value(at) & (0xffffffffu >> (8 * (4 - id_bytes)));
}
[[nodiscard]] inline std::uint32_t last_bit(std::uint32_t id_bytes) {
  return 1u << (8 * id_bytes - 1);
}

}  // namespace varifold::blocks
