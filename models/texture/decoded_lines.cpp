/// Which lines a cache of decoded texels looks up for the blocks of a plan (sample.h).
#include "models/base/error.h"
#include "models/texture/block/block_format.h"
#include "models/texture/sample.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {
namespace {

constexpr auto kLine = static_cast<std::uint32_t>(kLineBytes);

/// The sectors that hold `bytes` (at most a line's) from an address on, which lie in one line.
TextureLine sectors_of(std::uint64_t at, std::uint32_t bytes) {
  const auto begin = static_cast<std::uint32_t>(at % kLineBytes / kSectorBytes),
             end = static_cast<std::uint32_t>((at % kLineBytes + bytes + kSectorBytes - 1) / kSectorBytes);
  return {static_cast<std::uint32_t>(at / kLineBytes), (1u << end) - (1u << begin)};
}

/// Numbers of the lines of two textures differ if decoded texels are counted from `expansion` times the
/// address. Blocks that become more than eight times as large count from a number of their own.
struct Numbering {
  std::uint64_t expansion, first, end;
};
constexpr std::uint64_t kLargeFirst = std::uint64_t{1} << 30;
constexpr Numbering kSmall{8, 0, kLargeFirst}, kLarge{64, kLargeFirst, 2 * kLargeFirst};

std::uint32_t line_number(const Numbering& numbering, std::uint64_t base, std::uint64_t line) {
  const std::uint64_t number = numbering.first + base * numbering.expansion / kLineBytes + line;
  if (number >= numbering.end)
    throw user_error(
        "texture.blocks_held: decoded lines can be kept of textures in the first {} bytes of memory; one "
        "lies at {}",
        (numbering.end - numbering.first) * kLineBytes / numbering.expansion, base);
  return static_cast<std::uint32_t>(number);
}

}  // namespace

int decoded_line_shift(Format format) {
  return std::countr_zero(kLine / format_bytes(decoded_format(format)));
}

void add_decoded_lines(const TexturePlan& plan, std::vector<DecodedLine>& lines) {
  const BlockCodeInfo& code = block_code_info(block_code(plan.format));
  // A block's texels take a power of two of bytes: part of a line, or several.
  const std::uint32_t decoded = std::uint32_t{code.decoded_bytes} << block_places(plan.format).place_bits;
  const Numbering& numbering = decoded <= kSmall.expansion * code.bytes ? kSmall : kLarge;
  QUADRILLE_CHECK(decoded <= numbering.expansion * code.bytes, "{}: {} bytes become {}", code.name,
                  code.bytes, decoded);
  const std::uint32_t blocks = std::max(1u, kLine / decoded), block_lines = std::max(1u, decoded / kLine);
  const std::size_t first = lines.size();
  const auto add = [&](std::uint32_t line, std::uint32_t first_block) {
    const std::uint32_t number = line_number(numbering, plan.base, line);
    const auto seen = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(),
                                   [number](const DecodedLine& l) { return l.line == number; });
    if (seen != lines.end()) return;
    lines.push_back({number,
                     sectors_of(plan.base + std::uint64_t{first_block} * code.bytes, blocks * code.bytes),
                     blocks});
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.block_count); ++i) {
    const std::uint32_t block = plan.blocks[i];
    if (block_lines == 1) {
      add(block / blocks, block / blocks * blocks);
      continue;
    }
    for (std::uint32_t line = 0; line < block_lines; ++line)
      if ((plan.block_lines[i] >> line & 1) != 0) add(block * block_lines + line, block);
  }
}

}  // namespace quadrille::models
