/// How fast warps execute: host time of one warp-instruction (32 lanes) for single operations and for a mix
/// like that of a physically based material.
#include "models/shader/warp.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace quadrille::models {
namespace {

/// A fragment warp of one triangle, or of eight, with the outputs it writes.
struct Machine {
  explicit Machine(const Program& program, bool eight_triangles) {
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      const float t = static_cast<float>(lane) / kWarpLanes;
      in.x[lane] = in.y[lane] = t * 100;
      in.z[lane] = in.inv_w[lane] = in.persp_1[lane] = in.linear_1[lane] = 0.25f + 0.5f * t;
      in.persp_2[lane] = in.linear_2[lane] = 0.1f;
      in.front_facing[lane] = ~0u;
      in.primitive_id[lane] = 0;
    }
    planes.resize(kWarpQuads);
    for (std::size_t q = 0; q < planes.size(); ++q) {
      planes[q].assign(3 * kMaxVaryings, 0.3f);
      in.varyings[q] = planes[eight_triangles ? q : 0].data();
    }
    constants.assign(program.constants.words, 0x3f000000u);
    for (const auto& range : program.constants.ranges)
      for (std::size_t i = 0; i < range.literals.size(); ++i)
        constants[range.first_word + i] = range.literals[i];
    outputs.resize(8);
    warp.fragment = &in;
    warp.outputs = outputs.data();
  }

  void run(const Program& program, LaneMask lanes) {
    warp.launch(program, constants.data(), lanes);
    while (run_clause(warp).end == ClauseEnd::kRequests)
      for (int i = 0; i < warp.texture_count; ++i)
        write_texture_result(warp, warp.textures[static_cast<std::size_t>(i)], texels);
  }

  FragmentInputs in{};
  std::vector<std::vector<float>> planes;
  std::vector<std::uint32_t> constants;
  std::vector<LaneWords> outputs;
  std::array<LaneFloats, 4> texels{};
  Warp warp;
};

void measure(benchmark::State& state, const Program& program, bool eight_triangles = false) {
  Machine machine(program, eight_triangles);
  for (auto _ : state) machine.run(program, ~0u);
  const auto instructions = static_cast<double>(program.code.size());
  state.counters["warp_instr/s"] =
      benchmark::Counter(instructions, benchmark::Counter::kIsIterationInvariantRate);
}

std::string repeated(const std::string& line, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += line;
  return text;
}

void single_operation(benchmark::State& state, const std::string& line) {
  measure(state, assemble(".stage fragment\n.regs 16\n.varying perspective\n" + repeated(line, 256) + "end\n",
                          "bench"));
}
BENCHMARK_CAPTURE(single_operation, fadd, "fadd r0, r1, r2\nfadd r3, r4, r5\n");
BENCHMARK_CAPTURE(single_operation, fmad, "fmad r0, r1, r2, r3\nfmad r4, r5, r6, r7\n");
BENCHMARK_CAPTURE(single_operation, fmad_constant, "fmad r0, r1, 0.5, r3\nfmad r4, r5, 2.0, r7\n");
BENCHMARK_CAPTURE(single_operation, fmul_modified, "fmul.sat r0, -r1, r2\nfmul r4, |r5|, r7\n");
BENCHMARK_CAPTURE(single_operation, frcp, "frcp r0, r1\n");
BENCHMARK_CAPTURE(single_operation, frsq, "frsq r0, r1\n");
BENCHMARK_CAPTURE(single_operation, fexp2, "fexp2 r0, r1\n");
BENCHMARK_CAPTURE(single_operation, flog2, "flog2 r0, r1\n");
BENCHMARK_CAPTURE(single_operation, fsin, "fsin r0, r1\n");
BENCHMARK_CAPTURE(single_operation, interp, "interp r0, vary0\n");

/// 17 varyings, 5 textures, a normal map, three lights with a Cook-Torrance term, tone curve: the operations
/// in the proportions of such a shader.
Program material() {
  std::string text = ".stage fragment\n.regs 64\n" + repeated(".varying perspective\n", 17) +
                     repeated(".texture set=0 binding=0\n", 5);
  for (int i = 0; i < 17; ++i) text += "interp r" + std::to_string(i) + ", vary" + std::to_string(i) + "\n";
  for (int t = 0; t < 5; ++t)
    text += "tex r" + std::to_string(20 + 4 * t) + ", t" + std::to_string(t) + ", r0, r1\n";
  const std::string normalise =
      "fmul r40, r2, r2\nfmad r40, r3, r3, r40\nfmad r40, r4, r4, r40\nfrsq r40, r40\nfmul r41, r2, "
      "r40\nfmul r42, r3, r40\nfmul r43, r4, "
      "r40\n";
  const std::string dot = "fmul r44, r41, r5\nfmad r44, r42, r6, r44\nfmad.sat r44, r43, r7, r44\n";
  const std::string lobe =
      "fmul r45, r44, r44\nfmad r45, r45, r20, 1.0\nfmul r45, r45, r45\nfmul r45, r45, 3.14159\nfdiv r46, "
      "r21, r45\nfadd r47, 1.0, "
      "-r44\nfmul r48, r47, r47\n"
      "fmul r48, r48, r48\nfmul r48, r48, r47\nfmad r49, r48, r22, r23\nfmul r46, r46, r49\nfmax r46, r46, "
      "0.0\nfmad r50, r46, c0, "
      "r50\nfmad r51, r46, c1, r51\n"
      "fmad r52, r46, c2, r52\n";
  text = ".push c0 offset=0 words=4\n" + text;
  text += repeated(normalise + dot, 2);
  for (int light = 0; light < 3; ++light)
    text += normalise + dot + lobe + "flt r53, r44, 0.0\nselect r50, r53, r51, r50\n" + dot + lobe;
  text += "flog2 r50, r50\nfmul r50, r50, 0.4545\nfexp2 r50, r50\n";
  text += "output out0, r50\noutput out1, r51\noutput out2, r52\noutput out3, r23\nend\n";
  return assemble(text, "material");
}
void material_one_triangle(benchmark::State& state) { measure(state, material()); }
void material_eight_triangles(benchmark::State& state) { measure(state, material(), true); }
BENCHMARK(material_one_triangle);
BENCHMARK(material_eight_triangles);

/// The same work with half of the lanes switched off by an IF.
void divided(benchmark::State& state) {
  const std::string body = repeated("fmad r4, r5, r6, r7\nfadd r8, r9, 1.0\nfmul r10, r11, r12\n", 80);
  measure(state, assemble(".stage fragment\n.regs 16\ninput r0, frag_coord_x\nflt r1, r0, 50.0\nif r1\n" +
                              body + "else\nendif\nend\n",
                          "divided"));
}
BENCHMARK(divided);

}  // namespace
}  // namespace quadrille::models

BENCHMARK_MAIN();
