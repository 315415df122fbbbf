/// The order of instructions: independent chains are interleaved as far as that costs no warp, and what a
/// program computes does not depend on the machine that it is compiled for.
#include "models/shader/timing.h"
#include "pipeline/machine/machine_config.h"
#include "tests/pipeline/compiler/random_shader_run.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

namespace quadrille::pipeline {
namespace {

/// Each register more costs a warp: the compiler keeps to as few as it can.
const ShaderTarget kEveryRegisterCounts{.warp_slots = 1 << 20, .register_rows = 1 << 20};

/// Cycles of the first straight run for a warp alone, and those in which it issues.
models::ProgramTiming::Run first_run(const models::Program& program) {
  return models::ProgramTiming(program, ShaderTarget{}.timing).run(0);
}

/// `chains` components (a multiple of four) of multiply-adds that depend on each other, summed up.
std::string chains_source(int chains, int steps) {
  std::string body;
  for (int c = 0; c < chains / 4; ++c) {
    const std::string v = "v" + std::to_string(c);
    body += "vec4 " + v + " = " + (c % 2 == 0 ? "a" : "b") + " * " + std::to_string(c + 2) + ".0;";
    for (int i = 0; i < steps; ++i) body += v + " = " + v + " * " + v + " + 0.25;";
  }
  body += "color = v0;";
  for (int c = 1; c < chains / 4; ++c) body += "color = color * 0.5 + v" + std::to_string(c) + ";";
  return fragment_source(body);
}

}  // namespace

TEST_CASE("order: the compiler's default target is the default machine's core") {
  const ShaderTarget ours, machine = MachineConfig().shader_target();
  CHECK(ours.warp_slots == machine.warp_slots);
  CHECK(ours.register_rows == machine.register_rows);
  CHECK(ours.timing.classes == machine.timing.classes);
}

TEST_CASE("order: warps that fit, and the most registers that leave as many") {
  const ShaderTarget target{.warp_slots = 32, .register_rows = 1024};
  CHECK(target.warps(1) == 32);
  CHECK(target.warps(32) == 32);
  CHECK(target.warps(33) == 31);
  CHECK(target.warps(64) == 16);
  CHECK(target.most_registers(32) == 32);
  CHECK(target.most_registers(31) == 33);
  CHECK(target.most_registers(16) == 64);
  CHECK(target.most_registers(1) == models::kMaxRegisters);
}

TEST_CASE("order: a vec4 chain issues without a gap, a single chain at the latency of its operation") {
  constexpr int kSteps = 64;
  const auto source = [](const char* type, const char* components, const char* color) {
    std::string text = "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() {\n" +
                       std::string(type) + " c = gl_FragCoord." + components + ";\n";
    for (int i = 0; i < kSteps; ++i) text += "c = c * 0.99 + 0.25;\n";
    return text + "color = " + color + ";\n}\n";
  };
  const ShaderTarget target;
  const auto& alu = target.timing.of(models::Op::kFMad);
  // Four components: as many reads of the pixel's place, steps and outputs.
  const auto four = first_run(compile_fragment(source("vec4", "xyzw", "c")));
  CHECK(four.work == 4 * (1 + kSteps + 1) * alu.issue);
  CHECK(four.span == four.work);
  const auto two = first_run(compile_fragment(source("vec2", "xy", "vec4(c, 0, 1)")));
  CHECK(two.work == (2 * (1 + kSteps) + 4) * alu.issue);
  CHECK(two.span == two.work);
  // One: a step waits for the one before it. The outputs of constants fill what the last one waits.
  const auto one = first_run(compile_fragment(source("float", "x", "vec4(0, 0, 1, c)")));
  CHECK(one.span >= kSteps * alu.latency);
  CHECK(one.span <= (kSteps + 1) * alu.latency + 4 * alu.issue);
}

TEST_CASE("order: interleaving costs no warp, on either side of the step") {
  int better = 0, at_the_step = 0;
  for (const int chains : {4, 8, 16, 20, 24, 28, 32, 36, 48, 60}) {
    const std::string source = chains_source(chains, 6);
    const models::Program few = compile_fragment(source, kEveryRegisterCounts),
                          ours = compile_fragment(source);
    const ShaderTarget target;
    INFO(chains << " chains: " << few.num_regs << " registers at least, " << ours.num_regs << " taken");
    CHECK(target.warps(ours.num_regs) == target.warps(few.num_regs));
    CHECK(first_run(ours).span <= first_run(few).span);
    better += first_run(ours).span < first_run(few).span ? 1 : 0;
    at_the_step += target.warps(ours.num_regs + 1) < target.warps(ours.num_regs) ? 1 : 0;
  }
  CHECK(better > 0);
  CHECK(at_the_step > 0);
}

TEST_CASE("order: a machine with few registers gets a program with few") {
  const std::string source = chains_source(16, 6);
  const ShaderTarget small{.warp_slots = 32, .register_rows = 256};
  const models::Program few = compile_fragment(source, kEveryRegisterCounts);
  CHECK(small.warps(compile_fragment(source, small).num_regs) == small.warps(few.num_regs));
}

TEST_CASE("order: the machine that a program is compiled for does not change what it computes") {
  ShaderTarget slow;
  for (auto& c : slow.timing.classes) c.latency = 100;
  for (std::uint32_t seed = 5000; seed < 5060; ++seed) {
    INFO("seed " << seed);
    const RandomShader shader =
        random_shader(seed, seed % 2 == 0 ? traces::ShaderStage::kFragment : traces::ShaderStage::kVertex);
    const RandomShaderResult plain = run_compiled(shader);
    CHECK(run_compiled(shader, kEveryRegisterCounts) == plain);
    CHECK(run_compiled(shader, slow) == plain);
  }
}

TEST_CASE("order: differences in divergent flow are ordered alike for every machine") {
  const std::string source = fragment_source(
      "vec4 v = a; if (i.x > 0) { v = a * b + a; v.x = dFdx(v.x * b.y); v = v * v + b; v = v * v + a; } "
      "color = v;");
  CHECK(compile_fragment(source, kEveryRegisterCounts) == compile_fragment(source));
}

}  // namespace quadrille::pipeline
