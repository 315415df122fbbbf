/// Kinds of misses of whole frames: they add up to the misses, change nothing, and follow from the caches'
/// shapes.
#include "pipeline/report/miss_kinds.h"

#include <catch2/catch.hpp>

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

constexpr DetailOptions kMisses{.misses = true};

struct Kinds {
  std::uint64_t look_ups = 0, misses = 0, compulsory = 0, capacity = 0, conflict = 0, associative = 0;
};

Kinds kinds_of(const traces::CommandStream& stream, const std::vector<std::string>& settings) {
  MachineConfig config;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    config.set(setting.substr(0, equals), setting.substr(equals + 1), "test");
  }
  const std::string text = hw::contract::in_child([&] {
    const RenderedFrame frame = render_exact(stream, config, {}, {}, kMisses);
    const MissKindFigures m = all_texture_misses(frame.figures);
    return fmt::format("{} {} {} {} {} {}", m.look_ups, m.misses, m.of(models::MissKind::kCompulsory),
                       m.of(models::MissKind::kCapacity), m.of(models::MissKind::kConflict),
                       m.kinds.associative_misses);
  });
  Kinds k;
  std::istringstream(text) >> k.look_ups >> k.misses >> k.compulsory >> k.capacity >> k.conflict >>
      k.associative;
  return k;
}

}  // namespace

TEST_CASE("miss kinds: of random frames on random machines they add up and change nothing") {
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
    CHECK((run({}) == run(kMisses)));
  }
}

TEST_CASE("miss kinds: more ways take misses from conflicts, and with all ways and LRU there are none") {
  scenes::SceneOptions options;
  options.width = 160;
  options.height = 96;
  const traces::CommandStream stream = scenes::load_scene("builtin:courtyard", options);
  // few lines under way: those keep their places, so that with many the order would not quite be that of LRU
  const auto with = [&](int ways) {
    return kinds_of(stream, {"gpu.cores=1", "texture.cache_lines=64", "texture.cache_misses=8",
                             fmt::format("texture.cache_ways={}", ways)});
  };
  const Kinds direct = with(1), four = with(4), all = with(64);
  for (const Kinds& k : {direct, four, all}) {
    CHECK(k.compulsory + k.capacity + k.conflict == k.misses);
    CHECK(k.associative >= k.compulsory + k.capacity);
    CHECK(k.compulsory > 0);
    CHECK(k.capacity > 0);
  }
  CHECK(direct.conflict > four.conflict);
  CHECK(four.conflict > 0);
  CHECK(all.conflict == 0);
  CHECK(all.misses == all.associative);
}

TEST_CASE("miss kinds: the table and the JSON name them, where they were asked for") {
  const traces::CommandStream stream = scenes::load_scene("builtin:quad", {});
  const MachineConfig config;
  const auto texts = [&](const DetailOptions& detail) {
    return hw::contract::in_child([&] {
      const RenderedFrame frame = render_exact(stream, config, {}, {}, detail);
      const ReportSubject subject{frame.figures, config, 640, 480};
      return report_table(subject) + report_json(subject);
    });
  };
  const std::string asked = texts(kMisses), not_asked = texts({});
  for (const char* word : {"MISSES  of the texture caches", "\"texture_misses\"", "\"associative_misses\""}) {
    CHECK(asked.find(word) != std::string::npos);
    CHECK(not_asked.find(word) == std::string::npos);
  }
}
