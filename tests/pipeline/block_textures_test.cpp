/// Compressed textures in the machine: how many bytes and decoded blocks a picture of known texels takes.
#include "pipeline/render.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/texture_card.h"

#include <catch2/catch.hpp>

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
  std::uint64_t read_bytes = 0, blocks_decoded = 0;
};

/// Of the one texture unit of a machine of one core, whose cache the texture fits in.
Counts counts_of(Format format, hw::BlocksHeld held) {
  MachineConfig config;
  config.gpu.cores.set(1);
  config.texture.blocks_held.set(held);
  const RenderedFrame frame = render_exact(texel_a_pixel(format), config);
  REQUIRE(frame.figures.checks_hold());
  Counts counts;
  for (const UnitFigures& unit : frame.figures.units) {
    if (unit.path.find("texture") == std::string::npos) continue;
    for (const CounterFigure& counter : unit.counters) {
      if (counter.name == "read_bytes") counts.read_bytes += counter.value;
      if (counter.name == "blocks_decoded") counts.blocks_decoded += counter.value;
    }
  }
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
  for (const Format format : {Format::kBc1RgbUnorm, Format::kBc3Srgb, Format::kBc4Snorm, Format::kBc5Unorm,
                              Format::kBc6hUfloat, Format::kBc7Srgb}) {
    for (const char* held : {"compressed", "decoded"}) {
      Settings settings = little;
      settings.emplace_back("texture.blocks_held", held);
      INFO(models::format_info(format).name << ' ' << held);
      CHECK(faults_on(settings, texel_a_pixel(format)) == "");
    }
  }
}
