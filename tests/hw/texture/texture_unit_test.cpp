/// Texture unit: latency of hits and misses, answers in order, a cache of one line.
#include "hw/texture/texture_unit.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kMemory = 50;

struct TextureBench final : Bench {
  struct Setup {
    std::vector<Timed<TextureToken>> requests;
    int groups = 32, lines = 256, ways = 8, misses = 64, filter_clk = 8;
    Pace pace{};
    LinkSpec out{.depth = 64};
    bool encoded = false;  ///< the texture's first line lies in two sectors
  };
  /// A texture of 32 x 32 texels, nearest filter. Slot i samples one quad in the line of texels (8 i, 0);
  /// slot 3 samples eight quads there.
  TextureBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v), slots(4) {
    const std::vector<std::byte> texels(32 * 32 * 4, std::byte{0x7f});
    TextureState texture;
    texture.view = models::allocate_texture(device, models::Format::kR8G8B8A8Unorm, 32, 32, 1);
    models::tile_texture(device, texture.view, texels);
    texture.sampler.mag = texture.sampler.min = texture.sampler.mip = models::Filter::kNearest;
    DrawState draw;
    draw.fragment.textures = {texture};
    frame.draws = {draw};
    for (std::uint32_t i = 0; i < 4; ++i) {
      models::TextureRequest& request = slots[i].warp.textures[0];
      slots[i].warp.texture_count = 1;
      request.op = models::Op::kTexLod;
      request.active = i == 3 ? ~0u : 0xfu;
      request.u.fill((8.0f * static_cast<float>(i) + 1.5f) / 32.0f);
      request.v.fill(1.5f / 32.0f);
      request.lod.fill(0);
    }
    params.groups_in_flight.set(s.groups);
    set_cache(params, s.lines, s.ways, s.misses);
    params.filter_clk.set(s.filter_clk);
    if (s.encoded)
      device.stored_lines().set_encoded(static_cast<std::uint32_t>(texture.view.base / models::kLineBytes),
                                        2);
    unit = std::make_unique<TextureUnit>("unit", context(), params, slots);
    add(*unit);
    feed(unit->request_in, s.requests);
    sink = &drain<TextureToken>(
        unit->response_out, [](const TextureToken& t) { return t.slot; }, s.pace, s.out);
    memory = &serve(unit->memory_port(), kMemory);
  }
  TextureUnit::Params params;
  Store<CoreSlot> slots;
  std::unique_ptr<TextureUnit> unit;
  StubSink<TextureToken>* sink = nullptr;
  StubMemory* memory = nullptr;
};

TextureToken slot(std::uint32_t i) { return {i, DrawId(0), models::ShaderStage::kFragment}; }
std::string answers(const TextureBench& b) { return b.sink->text(); }

}  // namespace

TEST_CASE("texture_unit: the filter's latency is paid after the last line, by a miss and by a hit") {
  for (const int filter : {0, 8, 20}) {
    const TextureBench::Setup s{.requests = {{0, slot(0)}, {200, slot(0)}}, .filter_clk = filter};
    const auto text = run<TextureBench>(s, [](const TextureBench& b) {
      return fmt::format("{} requests {} hits {} misses {}", b.sink->text(), b.memory->got.size(),
                         counter(*b.unit, "cache_hits"), counter(*b.unit, "cache_misses"));
    });
    // Taken at 1; the line is there at 3 + memory. Then, and after a hit's address cycle, come a filter cycle
    // and the latency. The sink sees it one cycle later.
    CHECK(text == fmt::format("{}:0 {}:0 requests 1 hits 1 misses 1", 3 + kMemory + filter + 1 + 1,
                              201 + 1 + filter + 1 + 1));
  }
}

TEST_CASE("texture_unit: eight quads take four cycles of addresses and four of filtering") {
  const TextureBench::Setup s{.requests = {{0, slot(3)}, {200, slot(3)}, {200, slot(3)}}};
  CHECK(run<TextureBench>(s, answers) == "66:3 218:3 222:3");
}

TEST_CASE("texture_unit: a hit behind a miss is looked up at once and answered in order") {
  const TextureBench::Setup s{.requests = {{0, slot(0)}, {200, slot(1)}, {200, slot(0)}, {200, slot(2)}}};
  const auto text = run<TextureBench>(s, [](const TextureBench& b) {
    return fmt::format("{} last request at {}", b.sink->text(), b.memory->got.back().cycle);
  });
  CHECK(text == "63:0 263:1 264:0 265:2 last request at 204");
}

TEST_CASE("texture_unit: no more groups are under way than allowed") {
  const TextureBench::Setup s{.requests = {{0, slot(0)}, {0, slot(1)}}, .groups = 1};
  CHECK(run<TextureBench>(s, answers) == "63:0 124:1");  // taken at 62, the cycle the first is answered
}

TEST_CASE("texture_unit: an encoded line is read by its encoding, and all of it is there then") {
  const auto seen = [](bool encoded) {
    return run<TextureBench>(
        {.requests = {{0, slot(0)}, {100, slot(0)}}, .encoded = encoded}, [](const TextureBench& b) {
          const MemoryRequest& first = b.memory->got.front().token;
          return fmt::format("{} requests, sectors {:x}, encoded {} in {} bytes", b.memory->got.size(),
                             first.sectors, counter(*b.unit, "encoded_reads"),
                             counter(*b.unit, "encoded_read_bytes"));
        });
  };
  CHECK(seen(false) == "1 requests, sectors 1, encoded 0 in 0 bytes");
  CHECK(seen(true) == "1 requests, sectors 3, encoded 1 in 64 bytes");
}

TEST_CASE("texture_unit: a cache of one line and one miss gets through") {
  const TextureBench::Setup s{.requests = {{0, slot(0)}, {0, slot(1)}, {0, slot(2)}, {0, slot(0)}},
                              .lines = 1,
                              .ways = 1,
                              .misses = 1};
  const auto text = run<TextureBench>(s, [](const TextureBench& b) {
    return fmt::format("{} requests {}", b.sink->text(), b.memory->got.size());
  });
  CHECK(text == "63:0 115:1 167:2 219:0 requests 4");  // a line every 52 cycles: there and back
}

TEST_CASE("texture_unit: keeps the contract, one-deep links included") {
  TextureBench::Setup s{.requests = {{0, slot(0)}, {0, slot(3)}, {0, slot(1)}, {9, slot(0)}, {100, slot(2)}},
                        .groups = 2,
                        .pace = {.from = 0, .period = 7}};
  CHECK(contract_text<TextureBench>(s) == "");
  s.lines = s.ways = s.misses = 1;
  CHECK(contract_text<TextureBench>(s) == "");
}
