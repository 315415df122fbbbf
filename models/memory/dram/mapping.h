/// Which pseudo-channel, rank, bank and row hold a line of a channel.
///
/// From the least significant part of the line's number upward:
///   group   pseudo-channel, bank group, line of the row, bank of the group, rank, row
///   row     pseudo-channel, line of the row, bank group, bank of the group, rank, row
/// The first sends neighbouring lines to different bank groups, whose bursts may follow each other more
/// closely; the second fills a row before it opens the next. With `hash`, bank and group are exchanged by the
/// row's number, so that surfaces at a distance of whole rows meet in different banks. [P: Zhang, Zhu, Zhang,
/// A permutation-based page interleaving scheme, MICRO 2000]
#pragma once

#include "models/memory/dram/timing.h"

#include <cstdint>

namespace quadrille::models {

enum class DramInterleave { kGroup, kRow };

struct DramPlace {
  std::uint32_t pseudo_channel = 0;
  /// over all ranks of the pseudo-channel: (rank * groups + group) * banks of a group + bank
  std::uint32_t bank = 0;
  std::int32_t row = 0;
  std::uint32_t column = 0;  ///< first line of the row = 0, in lines of 128 bytes
};

class DramMapping {
 public:
  /// A row holds at least a line.
  DramMapping(const DramTiming& timing, DramInterleave interleave, bool hash);
  /// Lines beyond the device's capacity begin again at its first row.
  [[nodiscard]] DramPlace place(std::uint64_t line) const;

 private:
  std::uint32_t pseudo_channels_, groups_, group_banks_, ranks_, rows_, row_lines_;
  DramInterleave interleave_;
  bool hash_;
};

}  // namespace quadrille::models
