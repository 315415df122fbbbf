/// What each texture is asked for, banks of tags, groups of sectors and layouts, in whole frames: laws hold,
/// no pixel changes, and figures follow the arithmetic.
#include "pipeline/report/texture_use.h"

#include <catch2/catch.hpp>

#include <map>
#include <sstream>

#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_stream.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

traces::CommandStream scene(const std::string& name) {
  scenes::SceneOptions options;
  options.width = 160;
  options.height = 96;
  return scenes::load_scene(name, options);
}

/// Counters of all texture units by name, and "cycles", "laws" and "picture".
std::map<std::string, std::uint64_t> drawn(const traces::CommandStream& stream,
                                           const std::vector<std::string>& settings,
                                           const DetailOptions& detail = {}) {
  MachineConfig config;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    config.set(setting.substr(0, equals), setting.substr(equals + 1), "test");
  }
  const std::string text = hw::contract::in_child([&] {
    const RenderedFrame frame = render_exact(stream, config, {}, {}, detail);
    std::string all = fmt::format("cycles {} laws {} ", frame.figures.frame.cycles,
                                  static_cast<int>(frame.figures.checks_hold()));
    std::uint64_t picture = 0;
    for (const std::uint32_t pixel : frame.image.color) picture = picture * 31 + pixel;
    all += fmt::format("picture {} ", picture);
    for (const UnitFigures& unit : frame.figures.units)
      if (unit.path.starts_with("texture_"))
        for (const CounterFigure& counter : unit.counters)
          all += fmt::format("{} {} ", counter.name, counter.value);
    return all;
  });
  std::map<std::string, std::uint64_t> sums;
  std::istringstream words(text);
  std::string name;
  for (std::uint64_t value = 0; words >> name >> value;) sums[name] += value;
  return sums;
}

}  // namespace

TEST_CASE("texture use: of random frames on random machines the laws hold and nothing else changes") {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const traces::CommandStream stream = test::random_stream(seed);
    MachineConfig config;
    if (seed % 3 != 0) test::randomize(config, seed);
    INFO("seed " << seed);
    const auto run = [&](const DetailOptions& detail) {
      return hw::contract::in_child([&] {
        const RenderedFrame frame = render_exact(stream, config, {}, {}, detail);
        std::string text =
            fmt::format("{} cycles, laws {}", frame.figures.frame.cycles, frame.figures.checks_hold());
        for (const std::uint32_t pixel : frame.image.color) text += fmt::format(" {:x}", pixel);
        return text;
      });
    };
    CHECK((run({}) == run({.textures = true})));
  }
}

TEST_CASE("texture use: a frame's textures are named with their filters, levels and bytes") {
  const traces::CommandStream stream = scene("builtin:courtyard");
  const std::string text = hw::contract::in_child([&] {
    const RenderedFrame frame = render_exact(stream, {}, {}, {}, {.textures = true});
    std::string all = frame.figures.checks_hold() ? "" : "a law does not hold; ";
    std::uint64_t linear = 0, lanes = 0, levels = 0, memory = 0, bytes = 0;
    for (const TextureFigures& t : *frame.figures.textures) {
      if (t.image.name.empty() || t.image.end - t.image.begin < 4 * t.image.width * t.image.height)
        all += "an image without name or bytes; ";
      if (t.memory_bytes > t.use.read_bytes) all += t.image.name + " reads more of memory than of L2; ";
      linear += t.use.linear, lanes += t.use.lanes, memory += t.memory_bytes, bytes += t.use.read_bytes;
      for (const std::uint64_t count : t.use.levels) levels += count;
    }
    if (linear != lanes || levels != lanes || lanes == 0) all += "lanes are missing; ";
    if (memory == 0 || bytes == 0) all += "no bytes; ";
    return all;
  });
  CHECK(text.empty());
}

TEST_CASE("texture layouts: rows and Williams' pyramid cost look-ups, and the picture stays") {
  for (const char* name : {"builtin:courtyard", "builtin:quad"}) {
    const traces::CommandStream stream = scene(name);
    const auto in = [&](const std::string& layout) {
      return drawn(stream, {"gpu.cores=1", "texture.cache_lines=32", "texture.layout=" + layout});
    };
    auto tiled = in("tiled"), linear = in("linear"), morton = in("morton"), williams = in("williams");
    for (auto* other : {&tiled, &linear, &morton, &williams}) {
      CHECK((*other)["laws"] == 1);
      CHECK((*other)["picture"] == tiled["picture"]);
    }
    CHECK(williams["cache_requests"] > 2 * tiled["cache_requests"]);
    CHECK(williams["read_bytes"] > tiled["read_bytes"]);
    // Morton order has the tiles' lines of 8x4 texels: nearly the same look-ups.
    CHECK(morton["cache_requests"] < tiled["cache_requests"] * 11 / 10);
    // Rows of small levels share lines, so at such a size rows may be no worse.
    if (std::string(name) == "builtin:quad") CHECK(linear["cache_requests"] > tiled["cache_requests"]);
  }
}

TEST_CASE("texture caches: a miss that fetches more sectors asks for more bytes, and misses less often") {
  const traces::CommandStream stream = scene("builtin:courtyard");
  const auto with = [&](const std::string& sectors) {
    return drawn(stream, {"gpu.cores=1", "texture.fetched_sectors=" + sectors});
  };
  auto one = with("one"), two = with("two"), line = with("line");
  for (auto* each : {&one, &two, &line}) {
    CHECK((*each)["laws"] == 1);
    CHECK((*each)["picture"] == one["picture"]);
    CHECK((*each)["read_bytes"] == 32 * (*each)["sectors_filled"]);
    CHECK((*each)["sectors_used"] <= (*each)["sectors_filled"]);
  }
  CHECK(one["sectors_used"] == one["sectors_filled"]);
  CHECK(two["cache_misses"] < one["cache_misses"]);
  CHECK(line["cache_misses"] < two["cache_misses"]);
  CHECK(two["read_bytes"] > one["read_bytes"]);
  CHECK(line["read_bytes"] > two["read_bytes"]);
  CHECK(line["read_bytes"] == 128 * line["cache_misses"]);
}

TEST_CASE("texture caches: lines that meet in a bank of the tags take turns") {
  const traces::CommandStream stream = scene("builtin:courtyard");
  const auto with = [&](const std::string& rate, const std::string& banks) {
    return drawn(stream, {"gpu.cores=1", "texture.tags_per_clk=" + rate, "texture.tag_banks=" + banks});
  };
  auto ports = with("4", "1"), four = with("4", "4"), sixteen = with("16", "16"), one = with("1", "1");
  for (auto* each : {&ports, &four, &sixteen, &one}) {
    CHECK((*each)["laws"] == 1);
    CHECK((*each)["picture"] == ports["picture"]);
  }
  CHECK(ports["bank_conflict_clk"] == 0);
  CHECK(four["bank_conflict_clk"] > 0);
  CHECK(one["bank_conflict_clk"] == 0);
  // A look-up takes a cycle at least: conflicts are fewer cycles than look-ups.
  CHECK(four["bank_conflict_clk"] < four["cache_requests"]);
}
