/// What moved in each slice of a frame: the bytes of every client of the L2 cache and of the memory, and the
/// tokens that lay in the links.
///
/// Bytes are whole numbers of what the counters counted, so the slices of a client add up to its counters.
/// Tokens are summed over ticks, which are whole numbers too: the slices of a class of links add up to what
/// its links say at the end. The memory goes on writing behind the frame's end, so the last slice of all of
/// these lasts until nothing moves any more.
#pragma once

#include "hw/base/clock.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// Bytes of a client, slice by slice.
struct ClientCurve {
  std::string client;
  /// of the memory, what write-backs wrote is `written` and belongs to no other client
  std::vector<std::uint64_t> read, written;
};
/// How full the links of a class were.
struct LinkCurve {
  std::string key;                  ///< "link.coarse_to_fine"
  std::vector<std::uint64_t> held;  ///< by slice: tokens in all links of the class, summed over ticks
};

struct FlowFigures {
  hw::Tick slice = 0, end = 0;  ///< length of a slice; the last one ends when nothing moves any more
  std::size_t slices = 0;
  std::vector<ClientCurve> asked;   ///< of the L2 cache
  std::vector<ClientCurve> memory;  ///< by the memory channels
  std::vector<LinkCurve> links;
  [[nodiscard]] hw::Tick length_of(std::size_t s) const {
    return s + 1 < slices ? slice : end - static_cast<hw::Tick>(s) * slice;
  }
};

}  // namespace quadrille::pipeline
