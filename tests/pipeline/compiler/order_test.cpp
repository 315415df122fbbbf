/// The order of instructions: independent chains are interleaved as far as that costs no warp, and what a
/// program computes does not depend on the machine that it is compiled for.
#include "models/shader/timing.h"
#include "tests/pipeline/compiler/random_shader_run.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

namespace quadrille::pipeline {
namespace {

/// Each register more costs a warp: the compiler keeps to as few as it can.
const ShaderTarget kEveryRegisterCounts{.warp_slots = 1 << 20, .register_rows = 1 << 20};

/// One warp, whatever it takes.
const ShaderTarget kRegistersAreFree{.warp_slots = 1, .register_rows = 1 << 20};

/// Cycles of the first straight run for a warp alone, and those in which it issues.
models::ProgramTiming::Run first_run(const models::Program& program) {
  return models::ProgramTiming(program, ShaderTarget{}.timing).run(0);
}

/// Eight independent chains of multiply-adds while `held` other values wait for the end: one after the other
/// they need a register, side by side more.
std::string chains_source(int held, int steps) {
  const std::string inputs[] = {"a.x", "a.y", "a.z", "a.w", "b.x", "b.y", "b.z", "b.w"};
  const auto name = [](int k) { return "u" + std::to_string(k); };
  std::string body = "float start = 0.5;";
  for (int k = 0; k < held; ++k) {
    body += "float " + name(k) + " = " + inputs[k % 8] + " * " + std::to_string(k + 2) + ".0;";
    body += "start = start * 0.5 + " + name(k) + ";";
  }
  body += "float sum = start;";
  for (int c = 0; c < 8; ++c) {
    body += "float t" + std::to_string(c) + " = start * " + std::to_string(c + 2) + ".0;";
    const std::string t = "t" + std::to_string(c);
    for (int i = 0; i < steps; ++i) body += t + " = " + t + " * " + t + " + 0.25;";
    body += "sum = sum * 0.5 + " + t + ";";
  }
  for (int k = held; k-- > 0;) body += "sum = sum * 0.5 + " + name(k) + ";";
  return fragment_source(body + "color = vec4(sum);");
}

}  // namespace

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
  const ShaderTarget target;
  int better = 0, held_back = 0;
  for (int held = 4; held <= 70; held += 2) {
    const std::string source = chains_source(held, 12);
    const models::Program few = compile_fragment(source, kEveryRegisterCounts),
                          ours = compile_fragment(source), free = compile_fragment(source, kRegistersAreFree);
    INFO(held << " held: " << few.num_regs << " registers at least, " << ours.num_regs << " taken, "
              << free.num_regs << " if they were free; " << first_run(few).span << ", "
              << first_run(ours).span << ", " << first_run(free).span << " cycles");
    CHECK(target.warps(ours.num_regs) == target.warps(few.num_regs));
    CHECK(first_run(free).span <= first_run(ours).span);
    CHECK(first_run(ours).span <= first_run(few).span);
    better += first_run(ours).span < first_run(few).span ? 1 : 0;
    held_back += first_run(free).span < first_run(ours).span ? 1 : 0;
  }
  CHECK(better > 0);
  CHECK(held_back > 0);
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
