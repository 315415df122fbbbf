/// What the lanes of a storage instruction move, as lines and sectors: the coalescer of a load-store unit.
#pragma once

#include "models/shader/warp.h"

#include <vector>

namespace quadrille::models {

/// Sectors of one line that an instruction reads, writes or updates together.
struct StorageLine {
  std::uint32_t line = 0;    ///< device address / 128
  std::uint8_t sectors = 0;  ///< touched
  std::uint8_t whole = 0;    ///< those of them whose 8 words are all touched
};

/// Appends the lines of a request, in order of the lanes that first touch them; accesses outside of the view
/// touch nothing. Lanes of a load or store that touch one word share it. Updates of one word follow each
/// other: a line stands as often as the most updated of its words.
void add_lines(const StorageRequest& request, const StorageView& view, std::vector<StorageLine>& lines);

}  // namespace quadrille::models
