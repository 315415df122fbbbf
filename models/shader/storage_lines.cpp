#include "models/shader/storage_lines.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {
namespace {

constexpr std::uint32_t kWordsOfLine = kLineBytes / 4;
constexpr std::uint32_t kWordsOfSector = kSectorBytes / 4;

/// Words of a line that are touched together.
struct Touched {
  std::uint32_t line = 0, words = 0;
};

StorageLine line_of(const Touched& touched) {
  StorageLine line{touched.line, 0, 0};
  for (std::uint32_t s = 0; s < kLineSectors; ++s) {
    const std::uint32_t words = touched.words >> kWordsOfSector * s & ((1u << kWordsOfSector) - 1);
    if (words != 0) line.sectors = static_cast<std::uint8_t>(line.sectors | 1u << s);
    if (words == (1u << kWordsOfSector) - 1) line.whole = static_cast<std::uint8_t>(line.whole | 1u << s);
  }
  return line;
}

}  // namespace

void add_lines(const StorageRequest& request, const StorageView& view, std::vector<StorageLine>& lines) {
  std::vector<Touched> touched;
  const bool in_turn = is_atomic(request.op);
  for (LaneMask lanes = request.active; lanes != 0; lanes &= lanes - 1) {
    const std::uint32_t offset = request.offset[static_cast<std::size_t>(std::countr_zero(lanes))];
    if (offset > view.bytes || view.bytes - offset < 4) continue;
    const std::uint64_t word = (view.address + offset) / 4;
    const auto line = static_cast<std::uint32_t>(word / kWordsOfLine);
    const std::uint32_t bit = 1u << word % kWordsOfLine;
    const auto found = std::ranges::find_if(
        touched, [&](const Touched& t) { return t.line == line && (!in_turn || (t.words & bit) == 0); });
    if (found != touched.end()) found->words |= bit;
    else touched.push_back({line, bit});
  }
  for (const Touched& t : touched) lines.push_back(line_of(t));
}

}  // namespace quadrille::models
