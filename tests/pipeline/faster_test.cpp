/// Units that run faster than the machine has them: the same pictures, all laws, and figures that say so.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "pipeline/render.h"
#include "pipeline/report/comparison.h"
#include "pipeline/report/notes.h"
#include "pipeline/report/report.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_stream.h"

using namespace quadrille;
using namespace quadrille::pipeline;

namespace {

using Faster = std::vector<std::pair<std::string, double>>;

constexpr DetailOptions kAll{.draws = true, .tiles = true, .timeline = true};

RenderedFrame drawn(const traces::CommandStream& stream, const MachineConfig& config, const Faster& faster) {
  return render_exact(stream, config, {.faster = faster}, {}, kAll);
}

std::string picture(const RenderedFrame& frame) {
  std::string text;
  for (const std::uint32_t pixel : frame.image.color) text += fmt::format("{:x} ", pixel);
  for (const float depth : frame.image.depth) text += fmt::format("{} ", depth);
  return text;
}

/// One to four kinds of units, each 1 to 100 times as fast.
Faster random_units(std::mt19937& random) {
  const auto kinds = unit_kind_names();
  Faster faster;
  for (unsigned i = 0, count = 1 + random() % 4; i < count; ++i) {
    const std::string kind(*std::next(kinds.begin(), static_cast<std::ptrdiff_t>(random() % kinds.size())));
    const double times = std::pow(100.0, std::uniform_real_distribution(0.0, 1.0)(random));
    if (std::ranges::find(faster, kind, [](const auto& given) { return given.first; }) == faster.end())
      faster.emplace_back(kind, times);
  }
  return faster;
}

std::string words(const Faster& faster) {
  std::string text;
  for (const auto& [kind, times] : faster) text += fmt::format("{}={} ", kind, times);
  return text;
}

std::string report_of(const RenderedFrame& frame, const MachineConfig& config) {
  return report_json({frame.figures, config, frame.image.width, frame.image.height});
}

}  // namespace

TEST_CASE("faster units: random ones of random machines draw the same and break no law, of details neither") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const traces::CommandStream stream = test::random_stream(seed);
    MachineConfig config;
    if (seed % 3 != 0) test::randomize(config, seed);
    if (seed % 2 == 0) config.gpu.clock_mhz.parse("1755");  // cycles of unequal length
    const Faster faster = random_units(random);
    INFO("seed " << seed << ", faster " << words(faster));
    const auto run = [&](const Faster& units) {
      return hw::contract::in_child([&] {
        const RenderedFrame frame = drawn(stream, config, units);
        return failed_checks(frame.figures) + picture(frame);
      });
    };
    const std::string plain = run({}), fast = run(faster);
    CHECK((plain == fast));
    CHECK(plain.find("law broken") == std::string::npos);
  }
}

TEST_CASE("faster units: once as fast changes no cycle where clocks are equal anyhow") {
  const traces::CommandStream stream = test::random_stream(3);
  const MachineConfig config;
  const auto cycles = [&](const Faster& faster) {
    return hw::contract::in_child(
        [&] { return fmt::format("{}", drawn(stream, config, faster).figures.frame.cycles); });
  };
  CHECK(cycles({{"core", 1}}) == cycles({}));
}

TEST_CASE("faster units: figures, notes and comparisons name them") {
  const traces::CommandStream stream = test::random_stream(3);
  const MachineConfig config;
  const std::string plain =
      hw::contract::in_child([&] { return report_of(drawn(stream, config, {}), config); });
  const std::string fast = hw::contract::in_child([&] {
    const RenderedFrame frame = drawn(stream, config, {{"core", 1.5}});
    const std::vector<std::string> notes = notes_on(frame.figures);
    if (std::ranges::find(notes, "core: 1.5 times as fast as the machine has it") == notes.end())
      return std::string("no note");
    return report_of(frame, config);
  });
  CHECK(plain.find("\"faster\": {}") != std::string::npos);
  CHECK(fast.find("\"core\": 1.5") != std::string::npos);
  const std::string difference = comparison_json({"a.json", plain}, {"b.json", fast});
  CHECK(difference.find("\"faster.core\"") != std::string::npos);
}
