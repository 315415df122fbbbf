/// Compressed textures in the machine: how many bytes and decoded blocks a picture of known texels takes.
#include "pipeline/render.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/texture_card.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <sstream>
#include <string>
#include <string_view>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

using traces::Format;

/// Every pixel shows a texel of its own, so that each is read once.
traces::CommandStream texel_a_pixel(Format format) {
  TextureCard card;
  card.image = card_image(format, kCardSide, kCardSide, 1, 7);
  card.sampler.mag = card.sampler.min = card.sampler.mip = traces::Filter::kNearest;
  card.step = {1, 1};
  return card_stream(card);
}

struct Counts {
  std::uint64_t read_bytes = 0, blocks_decoded = 0, decode_slots = 0;
};

/// Of the one texture unit of a machine of one core, whose cache the texture fits in.
Counts counts_here(Format format, hw::BlocksHeld held) {
  MachineConfig config;
  config.gpu.cores.set(1);
  config.texture.blocks_held.set(held);
  const RenderedFrame frame = render_exact(texel_a_pixel(format), config);
  Counts counts;
  if (!frame.figures.checks_hold()) return counts;
  for (const UnitFigures& unit : frame.figures.units) {
    if (unit.path.find("texture") == std::string::npos) continue;
    for (const CounterFigure& counter : unit.counters) {
      if (counter.name == "read_bytes") counts.read_bytes += counter.value;
      if (counter.name == "blocks_decoded") counts.blocks_decoded += counter.value;
      if (counter.name == "decode_slots") counts.decode_slots += counter.value;
    }
  }
  return counts;
}

/// SystemC simulates once a process, so each is a process of its own.
Counts counts_of(Format format, hw::BlocksHeld held) {
  std::istringstream text(hw::contract::in_child([&] {
    const Counts counts = counts_here(format, held);
    return fmt::format("{} {} {}", counts.read_bytes, counts.blocks_decoded, counts.decode_slots);
  }));
  Counts counts;
  text >> counts.read_bytes >> counts.blocks_decoded >> counts.decode_slots;
  INFO(text.str());
  REQUIRE(!text.fail());
  REQUIRE(counts.read_bytes > 0);
  return counts;
}

constexpr std::uint64_t kTexels = std::uint64_t{kCardSide} * kCardSide, kBlocks = kTexels / 16;

}  // namespace

TEST_CASE("block textures: RGBA8 moves four bytes a texel") {
  const Counts counts = counts_of(Format::kR8G8B8A8Unorm, hw::BlocksHeld::kCompressed);
  CHECK(counts.read_bytes == 4 * kTexels);
  CHECK(counts.blocks_decoded == 0);
}

TEST_CASE("block textures: BC1 moves an eighth of the bytes of RGBA8") {
  const Counts counts = counts_of(Format::kBc1RgbaUnorm, hw::BlocksHeld::kCompressed);
  CHECK(counts.read_bytes == 4 * kTexels / 8);
  // A warp is 8x4 pixels, which are two blocks.
  CHECK(counts.blocks_decoded == kBlocks);
}

TEST_CASE("block textures: BC7 moves a fourth of the bytes of RGBA8") {
  const Counts counts = counts_of(Format::kBc7Unorm, hw::BlocksHeld::kCompressed);
  CHECK(counts.read_bytes == kTexels);
  CHECK(counts.blocks_decoded == kBlocks);
}

TEST_CASE("block textures: ETC2 and EAC move as many bytes as their blocks have") {
  for (const Format format : {Format::kEtc2Rgb8Unorm, Format::kEtc2Rgb8A1Srgb, Format::kEacR11Unorm}) {
    const Counts counts = counts_of(format, hw::BlocksHeld::kCompressed);
    CHECK(counts.read_bytes == kTexels / 2);
    CHECK(counts.blocks_decoded == kBlocks);
    CHECK(counts.decode_slots == kBlocks);
  }
  CHECK(counts_of(Format::kEtc2Rgba8Srgb, hw::BlocksHeld::kCompressed).read_bytes == kTexels);
  CHECK(counts_of(Format::kEacR11G11Snorm, hw::BlocksHeld::kCompressed).read_bytes == kTexels);
}

TEST_CASE("block textures: ASTC moves 16 bytes a block of any size, and takes two places of the decoder") {
  // Sectors hold two blocks, and there are even numbers of them in a row.
  for (const auto& [format, blocks] : {std::pair{Format::kAstc4x4Unorm, 12 * 12},
                                       {Format::kAstc5x4Srgb, 10 * 12},
                                       {Format::kAstc5x5Unorm, 10 * 10},
                                       {Format::kAstc6x6Unorm, 8 * 8},
                                       {Format::kAstc8x5Unorm, 6 * 10},
                                       {Format::kAstc8x8Srgb, 6 * 6},
                                       {Format::kAstc12x12Unorm, 4 * 4}}) {
    const Counts counts = counts_of(format, hw::BlocksHeld::kCompressed);
    INFO(models::format_info(format).name);
    CHECK(counts.read_bytes == 16 * static_cast<std::uint64_t>(blocks));
    CHECK(counts.blocks_decoded >= static_cast<std::uint64_t>(blocks));
    CHECK(counts.decode_slots == 2 * counts.blocks_decoded);
  }
  // A warp is 8x4 pixels: half a block of 8x8.
  CHECK(counts_of(Format::kAstc8x8Unorm, hw::BlocksHeld::kCompressed).blocks_decoded == 2 * 6 * 6);
}

TEST_CASE("block textures: a decoded block of ASTC fills several lines, each decoded by itself") {
  // 8x8 texels are two lines; 6x6 are 144 bytes, so the last row but four texels lies in a second line. Each
  // line fetches the sector of its block.
  const Counts eight = counts_of(Format::kAstc8x8Unorm, hw::BlocksHeld::kDecoded),
               six = counts_of(Format::kAstc6x6Unorm, hw::BlocksHeld::kDecoded),
               five = counts_of(Format::kAstc5x5Unorm, hw::BlocksHeld::kDecoded),
               four = counts_of(Format::kAstc4x4Unorm, hw::BlocksHeld::kDecoded);
  CHECK(eight.blocks_decoded == 2 * 6 * 6);
  CHECK(eight.read_bytes == 32 * 2 * 6 * 6);
  CHECK(six.blocks_decoded == 2 * 8 * 8);
  CHECK(six.read_bytes == 32 * 2 * 8 * 8);
  CHECK(five.blocks_decoded == 10 * 10);
  CHECK(five.read_bytes == 32 * 10 * 10);
  CHECK(four.blocks_decoded == kBlocks);
  CHECK(four.read_bytes == kTexels);
}

TEST_CASE("block textures: a slower decoder of ASTC takes longer, and leaves other codes alone") {
  const auto cycles = [](Format format, int slots) {
    return std::stoll(hw::contract::in_child([&] {
      MachineConfig config;
      config.gpu.cores.set(1);
      config.texture.decode_blocks_per_clk.set(1);
      config.texture.astc_decode_slots.set(slots);
      return std::to_string(render_exact(texel_a_pixel(format), config).figures.frame.cycles);
    }));
  };
  CHECK(cycles(Format::kAstc4x4Unorm, 32) > cycles(Format::kAstc4x4Unorm, 1) + 1000);
  CHECK(cycles(Format::kBc7Unorm, 32) == cycles(Format::kBc7Unorm, 1));
}

TEST_CASE("block textures: a cache of decoded lines fetches a sector of BC1 for each of its two lines") {
  // A line of 128 bytes is two decoded blocks of BC1, and a sector of 32 holds four: it comes twice.
  const Counts counts = counts_of(Format::kBc1RgbaUnorm, hw::BlocksHeld::kDecoded);
  CHECK(counts.read_bytes == 2 * 4 * kTexels / 8);
  CHECK(counts.blocks_decoded == kBlocks);
}

TEST_CASE("block textures: what the cache holds changes no pixel, and all laws hold") {
  const Settings little{{"texture.cache_lines", "4"},
                        {"texture.cache_ways", "2"},
                        {"texture.cache_misses", "1"},
                        {"texture.decode_blocks_per_clk", "1"}};
  for (const Format format :
       {Format::kBc1RgbUnorm, Format::kBc3Srgb, Format::kBc4Snorm, Format::kBc5Unorm, Format::kBc6hUfloat,
        Format::kBc7Srgb, Format::kEtc2Rgb8A1Srgb, Format::kEacR11G11Snorm, Format::kAstc4x4Unorm,
        Format::kAstc6x5Srgb, Format::kAstc12x10Unorm}) {
    for (const char* held : {"compressed", "decoded"}) {
      Settings settings = little;
      settings.emplace_back("texture.blocks_held", held);
      INFO(models::format_info(format).name << ' ' << held);
      CHECK(faults_on(settings, texel_a_pixel(format)) == "");
    }
  }
}
