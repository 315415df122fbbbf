/// The three laws on the whole machine: timing never changes pixels, every cycle is counted once, every byte
/// and fragment is accounted for.
#include "scenes/scene.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_stream.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline::test;

TEST_CASE(
    "machine: a hundred random machines give the pixels of the functional rendering, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const traces::CommandStream stream = random_stream(1 + seed / 10);
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

TEST_CASE("machine: a window of any size keeps pixels and laws, and never deadlocks") {
  constexpr hw::Tick kCycle = 1'000'000;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const traces::CommandStream stream = random_stream(1 + seed / 10);
    hw::contract::Variation variation;
    variation.window = kCycle << (seed * 5 % 13);  // 1 to 4096 cycles
    INFO("machine " << seed << ", window of " << variation.window / kCycle << " cycles");
    CHECK(machine_faults(stream, seed, variation) == "");
  }
}

TEST_CASE("machine: the end of a frame under a window is a few per cent off, however large the window") {
  constexpr hw::Tick kCycle = 1'000'000;
  // Frames this short, which memory limits, move by some per cent for any reason at all: the mean over
  // several is what a window does.
  constexpr std::uint64_t kStreams[] = {7, 8, 9, 10, 11, 12};
  for (const hw::Tick window : {1, 16, 256, 4096, 1'000'000}) {
    double sum = 0;
    for (const std::uint64_t seed : kStreams) {
      const traces::CommandStream stream = random_stream(seed, {120, 72, 30, 20});
      const auto exact = hw::contract::run_forked(machine_builder(stream, 0), {});
      hw::contract::Variation variation;
      variation.window = window * kCycle;
      const auto ahead = hw::contract::run_forked(machine_builder(stream, 0), variation);
      INFO("window of " << window << " cycles, stream " << seed << ": " << ahead.end << " fs, exact "
                        << exact.end << " fs");
      REQUIRE(ahead.failure.empty());
      const double off = std::abs(static_cast<double>(ahead.end) / static_cast<double>(exact.end) - 1);
      UNSCOPED_INFO("stream " << seed << " off by " << off);
      sum += off;
    }
    INFO("window of " << window << " cycles");
    CHECK(sum / static_cast<double>(std::size(kStreams)) < 0.025);
  }
}

TEST_CASE("machine: random streams give the pixels of the functional rendering on the default machine") {
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    const traces::CommandStream stream = random_stream(seed, {120, 72, 30, 20});
    INFO("stream " << seed);
    CHECK(machine_faults(stream, 0) == "");
  }
}

TEST_CASE(
    "machine: both drivers, any host order, any order of creating modules: the same cycles and figures") {
  const traces::CommandStream stream = random_stream(7, {64, 48, 8, 6});
  for (const std::uint64_t machine : {0u, 3u, 12u}) {
    INFO("machine " << machine);
    hw::contract::Options options;
    options.shuffles = 3;
    options.creations = 2;
    for (const std::string& violation : hw::contract::violations(machine_builder(stream, machine), options)) {
      UNSCOPED_INFO(violation);
      CHECK(violation.empty());
    }
  }
}

/// The same stream on the same machine, with everything built and without what it does not need.
void check_left_out(const traces::CommandStream& stream, std::uint64_t machine) {
  const auto without = hw::contract::run_forked(machine_builder(stream, machine, true), {});
  const auto with = hw::contract::run_forked(machine_builder(stream, machine, false), {});
  REQUIRE(without.failure.empty());
  REQUIRE(with.failure.empty());
  CHECK(without.digest == with.digest);
  CHECK(without.end == with.end);
  CHECK(with.figures.size() >= without.figures.size());
  for (const auto& [name, value] : without.figures) {
    if (name.starts_with("l2_") && name.find(".waited") != std::string::npos)
      continue;  // ports are numbered by client; there are more of them
    const auto same = with.figures.find(name);
    if (same == with.figures.end() || same->second != value) FAIL_CHECK(name << " differs");
  }
}

TEST_CASE("machine: what is left out changes neither pixels nor cycles") {
  scenes::SceneOptions options;
  options.width = 96;
  options.height = 64;
  for (const char* scene : {"builtin:triangle", "builtin:fill", "builtin:overdraw", "builtin:cubes"}) {
    for (const std::uint64_t machine : {0u, 5u}) {
      INFO(scene << " on machine " << machine);
      check_left_out(scenes::load_scene(scene, options), machine);
    }
  }
}

TEST_CASE("machine: random streams are the same with and without what they do not need") {
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    INFO("stream " << seed << " on machine " << seed % 4);
    check_left_out(random_stream(200 + seed, {48, 32, 5, 5}), seed % 4);
  }
}
