/// Lines of surfaces that are stored encoded, in whole frames: pictures, laws, who reads them, and what it
/// saves. Random machines have it too (tests/pipeline/random_machine.h).
#include "scenes/scene.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/plan_run.h"
#include "tests/pipeline/random_stream.h"

#include <catch2/catch.hpp>

#include <string_view>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

const Settings kBoth{{"depth.compression", "plane_offset"}, {"rop.compression", "samples_offset"}};
const Settings kLittleCache{
    {"depth.cache_lines", "8"}, {"depth.cache_ways", "4"}, {"rop.cache_lines", "8"}, {"rop.cache_ways", "4"}};

Settings operator+(Settings a, const Settings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The picture with these settings is the one without, and all laws hold.
void check_same_picture(const traces::CommandStream& stream, const Settings& settings) {
  const PlanRun run = run_plan(settings, false, stream);
  CHECK(run.failure.empty());
  CHECK(run.broken.empty());
  CHECK(run.digest == functional_digest(stream));
}

/// The sum of a counter over the units of a kind, on the random machine of that seed.
std::int64_t count(const traces::CommandStream& stream, std::uint64_t seed, std::string_view kind,
                   std::string_view counter) {
  const hw::contract::Outcome outcome = hw::contract::run_forked(machine_builder(stream, seed), {});
  std::int64_t sum = 0;
  for (const auto& [name, value] : outcome.figures)
    if (name.find(kind) != std::string::npos && name.ends_with(counter)) sum += value;
  return sum;
}

}  // namespace

TEST_CASE("compression: pictures and laws are those without, at 1 to 8 samples and with hardly any cache") {
  for (const std::uint32_t samples : {1u, 2u, 4u, 8u}) {
    INFO(samples << " samples");
    traces::CommandStream stream = random_stream(samples);
    if (samples > 1) traces::use_samples(stream, samples);
    check_same_picture(stream, kBoth);
    check_same_picture(stream, kBoth + kLittleCache);
    const Settings one_line{{"rop.cache_lines", "1"},  {"rop.cache_ways", "1"},
                            {"rop.cache_misses", "1"}, {"depth.cache_lines", "1"},
                            {"depth.cache_ways", "1"}, {"depth.cache_misses", "1"}};
    check_same_picture(stream, kBoth + one_line);
  }
}

TEST_CASE("compression: later passes load and sample what is stored encoded") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    check_same_picture(passes_stream(seed), kBoth);
    check_same_picture(passes_stream(seed), kBoth + kLittleCache);
  }
  constexpr std::uint64_t kBothOn = 5;  // the machine of this seed
  CHECK(count(passes_stream(1), kBothOn, "texture", "encoded_reads") > 0);
  CHECK(count(passes_stream(1), kBothOn, "rop", "encoded_reads") > 0);
  CHECK(count(passes_stream(1), kBothOn, "scan_out", "encoded_reads") > 0);
}
