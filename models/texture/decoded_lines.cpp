/// Which lines a cache of decoded texels looks up for the blocks of a plan (sample.h).
#include "models/base/error.h"
#include "models/texture/block/block_format.h"
#include "models/texture/sample.h"

#include <algorithm>

namespace quadrille::models {

void add_decoded_lines(const TexturePlan& plan, std::vector<DecodedLine>& lines) {
  const BlockCodeInfo& code = block_code_info(block_code(plan.format));
  // A block of 8 or 16 bytes becomes at most eight times as many, so numbers of the lines of two textures
  // differ if decoded texels are counted from eight times the address.
  constexpr std::uint64_t kMostExpansion = 8;
  const std::uint32_t decoded = kBlockTexels * code.decoded_bytes;
  QUADRILLE_CHECK(decoded <= kMostExpansion * code.bytes, "{}: {} bytes become {}", code.name, code.bytes,
                  decoded);
  const auto line_bytes = static_cast<std::uint32_t>(kLineBytes);
  const std::uint32_t blocks = line_bytes / decoded, bytes = blocks * code.bytes;
  const std::uint64_t base = plan.base * kMostExpansion / kLineBytes;
  const std::size_t first = lines.size();
  for (int i = 0; i < plan.block_count; ++i) {
    const std::uint32_t number = plan.blocks[static_cast<std::size_t>(i)] / blocks;
    const auto line = static_cast<std::uint32_t>(base + number);
    const auto seen = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(),
                                   [line](const DecodedLine& l) { return l.line == line; });
    if (seen != lines.end()) continue;
    const std::uint64_t at = plan.base + std::uint64_t{number} * bytes;
    const auto begin = static_cast<std::uint32_t>(at % kLineBytes / kSectorBytes),
               end = static_cast<std::uint32_t>((at % kLineBytes + bytes + kSectorBytes - 1) / kSectorBytes);
    lines.push_back(
        {line, {static_cast<std::uint32_t>(at / kLineBytes), (1u << end) - (1u << begin)}, blocks});
  }
}

}  // namespace quadrille::models
