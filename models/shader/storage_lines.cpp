#include "models/shader/storage_lines.h"

#include <array>
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
  std::array<Touched, kWarpLanes> touched;
  std::size_t count = 0;
  const bool in_turn = is_atomic(request.op);
  for (LaneMask lanes = request.active; lanes != 0; lanes &= lanes - 1) {
    const std::uint32_t offset = request.offset[static_cast<std::size_t>(std::countr_zero(lanes))];
    if (offset > view.bytes || view.bytes - offset < 4) continue;
    const std::uint64_t word = (view.address + offset) / 4;
    const auto line = static_cast<std::uint32_t>(word / kWordsOfLine);
    const std::uint32_t bit = 1u << word % kWordsOfLine;
    std::size_t i = 0;
    while (i < count && (touched[i].line != line || (in_turn && (touched[i].words & bit) != 0))) ++i;
    if (i == count) touched[count++] = {line, 0};
    touched[i].words |= bit;
  }
  for (std::size_t i = 0; i < count; ++i) lines.push_back(line_of(touched[i]));
}

}  // namespace quadrille::models
