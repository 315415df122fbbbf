/// How addresses and the screen are spread over members that work side by side: lines over L2 slices and over
/// the sets of a cache, tiles over partitions.
///
/// Lines are taken in blocks of as many as there are members. Each block has one line for every member, in
/// order but rotated, so that consecutive lines go to consecutive members, a member's lines keep their order,
/// and all members hold equally many. The rotation is the block's number, scattered: XOR of one word a bit
/// set, then scaled to the members (a tree of XOR gates and a small multiplier). The words are drawn so that
/// blocks which count up in any power of two take all rotations in turn; any other stride spreads as if by
/// chance, which no fixed modulus does. How even that is, and where it falls short of perfect,
/// tests/models/memory/interleave_test.cpp says (docs/deviations.md#D81).
///
/// Tiles of a row go to consecutive partitions; each row begins a few further on, by amounts searched for
/// every count of partitions.
#pragma once

#include "models/base/error.h"
#include "models/base/id.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// The scattered number: XOR of a word for every bit set, a byte at a time.
extern const std::array<std::array<std::uint32_t, 256>, 4> kScatter;
[[nodiscard]] inline std::uint32_t scatter(std::uint32_t number) {
  const std::uint32_t low = kScatter[0][number & 255] ^ kScatter[1][number >> 8 & 255];
  return number < 1u << 16 ? low : low ^ kScatter[2][number >> 16 & 255] ^ kScatter[3][number >> 24];
}

/// Lines over `members`, any number: line <-> (member, index within the member) is a bijection, with index =
/// line / members.
class Interleave {
 public:
  explicit Interleave(std::uint32_t members)
      : members_(members), reciprocal_(members < 2 ? 0 : ~std::uint64_t{0} / members + 1) {
    QUADRILLE_CHECK(members > 0, "nothing to interleave over");
  }

  [[nodiscard]] std::uint32_t members() const { return members_; }
  /// The line's number within its member.
  [[nodiscard]] std::uint32_t index_of(std::uint32_t line) const {
    // Exact for every 32-bit line: the reciprocal's error times 2^32 is below 1 / members.
    return members_ == 1 ? line : static_cast<std::uint32_t>((Wide{reciprocal_} * line) >> 64);
  }
  [[nodiscard]] std::uint32_t member_of(std::uint32_t line) const {
    const std::uint32_t index = index_of(line);
    const std::uint32_t member = line - index * members_ + rotation(index);
    return member < members_ ? member : member - members_;
  }
  /// The line at a place: the reverse of the two above.
  [[nodiscard]] std::uint32_t line_of(std::uint32_t member, std::uint32_t index) const {
    const std::uint32_t turn = rotation(index);
    return index * members_ + (member < turn ? member + members_ - turn : member - turn);
  }

 private:
  __extension__ using Wide = unsigned __int128;
  [[nodiscard]] std::uint32_t rotation(std::uint32_t block) const {
    return static_cast<std::uint32_t>((std::uint64_t{scatter(block)} * members_) >> 32);
  }

  std::uint32_t members_;
  std::uint64_t reciprocal_;  ///< 2^64 / members, rounded up
};

/// Partition, below `partitions` (1 to 64), that owns a tile of 8x8 pixels.
[[nodiscard]] PartitionId partition_of(std::uint32_t tile_x, std::uint32_t tile_y, std::uint32_t partitions);

}  // namespace quadrille::models
