/// Random structured programs, compiled, against the reference's interpreter, lane by lane.
///
/// The seeds are the same in every run. QUADRILLE_SHADER_SEEDS="FIRST COUNT" runs others, in one process a
/// case.
#include "models/base/error.h"
#include "tests/pipeline/compiler/random_shader_run.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cstdio>
#include <optional>

namespace quadrille::pipeline {
namespace {

using traces::ShaderStage;

/// A program may be beyond a limit of the machine; nothing else is a reason to refuse one.
bool is_limit(std::string_view message) {
  return message.find("registers") != std::string_view::npos ||
         message.find("nested deeper") != std::string_view::npos ||
         message.find("more than") != std::string_view::npos;
}

enum class Verdict : std::uint8_t { kAgrees, kDiffers, kRefused, kBeyondLimits };

Verdict judge(const RandomShader& shader, std::string& message) {
  const RandomShaderResult expected = run_in_reference(shader);
  try {
    return run_compiled(shader) == expected ? Verdict::kAgrees : Verdict::kDiffers;
  } catch (const UserError& error) { message = error.what(); }
  return is_limit(message) ? Verdict::kBeyondLimits : Verdict::kRefused;
}

/// False for a program that does not compile to SPIR-V at all.
bool has_verdict(const RandomShader& shader, Verdict wanted) {
  std::string message;
  try {
    return judge(shader, message) == wanted;
  } catch (const UserError&) { return false; }
}

/// Runs the programs of all seeds; says how many a limit refused, and shows the first that goes wrong as
/// small as it gets.
void check_seeds(ShaderStage stage, Seeds usual) {
  const Seeds seeds = seeds_or(usual);
  fmt::print("random shaders: QUADRILLE_SHADER_SEEDS=\"{} {}\"\n", seeds.first, seeds.count);
  std::fflush(stdout);
  std::uint32_t beyond_limits = 0;
  for (std::uint32_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
    INFO("seed " << seed);
    const RandomShader shader = random_shader(seed, stage);
    std::string message;
    const Verdict verdict = judge(shader, message);
    if (verdict == Verdict::kBeyondLimits) ++beyond_limits;
    if (verdict == Verdict::kAgrees || verdict == Verdict::kBeyondLimits) continue;
    const RandomShader small =
        shrink(shader, [&](const RandomShader& candidate) { return has_verdict(candidate, verdict); });
    FAIL_CHECK((verdict == Verdict::kRefused ? message : "differs from the reference") << "\n"
                                                                                       << small.source());
  }
  INFO(beyond_limits << " programs of " << seeds.count << " are beyond a limit of the machine");
  CHECK(beyond_limits * 50 <= seeds.count);
}

}  // namespace

TEST_CASE("random shaders: fragments, the first part") { check_seeds(ShaderStage::kFragment, {0, 800}); }
TEST_CASE("random shaders: fragments, the second part") { check_seeds(ShaderStage::kFragment, {800, 800}); }
TEST_CASE("random shaders: vertices") { check_seeds(ShaderStage::kVertex, {1600, 800}); }

TEST_CASE("random shaders: a program that fails is made small") {
  const auto fails = [](const RandomShader& shader) {
    return shader.source().find("continue;") != std::string::npos;
  };
  int tried = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const RandomShader shader = random_shader(seed, ShaderStage::kFragment);
    if (!fails(shader)) continue;
    ++tried;
    CHECK(shrink(shader, fails).statements() == 1);
  }
  CHECK(tried > 3);
}

}  // namespace quadrille::pipeline
