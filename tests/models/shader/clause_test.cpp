/// Where clauses end, what texture requests hold, and that values do not depend on lanes a lane has nothing
/// to do with.
#include "tests/models/shader/random_program.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

namespace quadrille::models::test {
namespace {

Program textured(const std::string& code) {
  return assemble(".stage fragment\n.texture set=0 binding=0\n.texture set=0 binding=1\n" + code + "end\n",
                  "test");
}

/// Texture requests of each clause of a program.
std::vector<int> requests_by_clause(const Program& program, LaneMask lanes = ~0u) {
  WarpFixture f;
  f.bind_constants(program);
  f.warp.launch(program, f.constants.data(), lanes);
  std::vector<int> counts;
  while (true) {
    const ClauseResult result = run_clause(f.warp);
    counts.push_back(f.warp.texture_count);
    if (result.end == ClauseEnd::kProgramEnd) return counts;
  }
}

std::string repeated(const std::string& line, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += line;
  return text;
}

using Counts = std::vector<int>;

}  // namespace

TEST_CASE("shader clauses: independent textures and what lies between them share a clause") {
  CHECK(requests_by_clause(
            textured("tex r0, t0, r8, r9\nfadd r10, r11, r12\ntex r4, t1, r8, r9\nfadd r13, r0, r4\n")) ==
        Counts{2, 0});
}

TEST_CASE("shader clauses: reading or overwriting a result ends the clause") {
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\ntex r4, t1, r3, r9\nmov r20, r4\n")) ==
        Counts{1, 1, 0});  // coordinates from a result
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\nmov r2, 1.0\n")) == Counts{1, 0});
  // shares r3
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\ntex r3, t0, r8, r9\n")) == Counts{1, 1, 0});
  // coordinates were copied
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\nmov r8, 1.0\nmov r4, 1.0\n")) == Counts{1, 0});
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\nkillif r10\nkillif r3\n")) == Counts{1, 0});
}

TEST_CASE("shader clauses: control flow, the end and the limit end the clause") {
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\n")) == Counts{1, 0});
  CHECK(requests_by_clause(textured("tex r0, t0, r8, r9\nif 1\ntex r4, t0, r8, r9\nendif\n")) ==
        Counts{1, 1, 0});
  std::string many;
  for (int i = 0; i < 2 * kMaxClauseRequests + 1; ++i)
    many += "tex r" + std::to_string(4 * i) + ", t0, r200, r201\n";
  CHECK(requests_by_clause(textured(many)) == Counts{8, 8, 1, 0});
  CHECK(requests_by_clause(textured("if 0\ntex r0, t0, r8, r9\nendif\n")) == Counts{0});
  CHECK(requests_by_clause(textured("mov r4, 0\nloop\nule r5, 3, r4\nbreakif r5\ntexlod r0, t0, r8, r9, "
                                    "0.0\niadd r4, r4, 1\nendloop\n")) == Counts{1, 1, 1, 0});
}

TEST_CASE("shader clauses: a request holds coordinates of all lanes and the lanes that executed") {
  WarpFixture f;
  const Program p = textured(
      "input r0, frag_coord_x\ninput r1, frag_coord_y\nflt r2, r0, 6.0\nif r2\n  texbias r4, t1, -r0, r1, "
      "0.75\nendif\n");
  f.bind_constants(p);
  f.warp.launch(p, f.constants.data(), ~0u);
  const ClauseResult result = run_clause(f.warp);
  REQUIRE(result.end == ClauseEnd::kRequests);
  REQUIRE(f.warp.texture_count == 1);
  const TextureRequest& request = f.warp.textures[0];
  CHECK(request.active == 0x3fu);
  CHECK(request.binding == 1);
  CHECK(request.dst == 4);
  CHECK(request.op == Op::kTexBias);
  for (std::size_t i = 0; i < kWarpLanes; ++i) {
    CHECK(request.u[i] == -f.fragment.x[i]);
    CHECK(request.v[i] == f.fragment.y[i]);
    CHECK(request.lod[i] == 0.75f);
  }
  write_texture_result(f.warp, request, WarpFixture::filtered(request));
  for (std::size_t i = 0; i < kWarpLanes; ++i) CHECK((f.warp.regs[5][i] != 0) == (i < 6));
  CHECK(run_clause(f.warp).end == ClauseEnd::kProgramEnd);
}

TEST_CASE("shader clauses: the cost of the clauses adds up to the instructions of the program") {
  const Program p =
      textured(repeated("interp r0, vary0\n", 0) +
               "fadd r9, r9, r9\ntex r0, t0, r8, r9\nfrcp r10, r9\nfadd r0, r0, r10\noutput out0, r0\n");
  WarpFixture f;
  const ClauseCost cost = f.run(p, 0xffu);
  CHECK(cost.alu == 2);
  CHECK(cost.sfu == 1);
  CHECK(cost.exported == 1);
  CHECK(cost.control == 1);
  CHECK(cost.lane_ops == 6 * 8);  // the texture instruction included
}

TEST_CASE("shader lanes: a quad's values do not depend on the other quads of its warp") {
  std::mt19937 random(11);
  for (int round = 0; round < 150; ++round) {
    const Program program = random_program(random, {});
    WarpFixture f;
    f.run(program);
    const auto outputs = f.outputs;
    const auto regs = f.warp.regs;
    const LaneMask killed = f.warp.killed;
    // The same quad in another place, among quads with other inputs, some absent.
    const std::size_t from = random() % kWarpQuads, to = random() % kWarpQuads;
    WarpFixture g;
    const FragmentInputs original = g.fragment;
    const auto shuffle = [&](auto& row) {
      for (auto& x : row) x = row[random() % kWarpLanes];
    };
    for (LaneFloats* row :
         {&g.fragment.x, &g.fragment.y, &g.fragment.z, &g.fragment.inv_w, &g.fragment.persp_1,
          &g.fragment.persp_2, &g.fragment.linear_1, &g.fragment.linear_2, &g.fragment.centroid_persp_1,
          &g.fragment.centroid_persp_2, &g.fragment.centroid_linear_1, &g.fragment.centroid_linear_2,
          &g.fragment.sample_x, &g.fragment.sample_y})
      shuffle(*row);
    shuffle(g.fragment.front_facing);
    const auto place = [&](auto& row, const auto& source) {
      std::copy_n(source.begin() + static_cast<std::ptrdiff_t>(4 * from), 4,
                  row.begin() + static_cast<std::ptrdiff_t>(4 * to));
    };
    place(g.fragment.x, original.x), place(g.fragment.y, original.y), place(g.fragment.z, original.z),
        place(g.fragment.inv_w, original.inv_w);
    place(g.fragment.persp_1, original.persp_1), place(g.fragment.persp_2, original.persp_2);
    place(g.fragment.linear_1, original.linear_1), place(g.fragment.linear_2, original.linear_2);
    place(g.fragment.centroid_persp_1, original.centroid_persp_1),
        place(g.fragment.centroid_persp_2, original.centroid_persp_2);
    place(g.fragment.centroid_linear_1, original.centroid_linear_1),
        place(g.fragment.centroid_linear_2, original.centroid_linear_2);
    place(g.fragment.sample_x, original.sample_x), place(g.fragment.sample_y, original.sample_y);
    place(g.fragment.sample_id, original.sample_id), place(g.fragment.sample_mask, original.sample_mask);
    place(g.fragment.front_facing, original.front_facing),
        place(g.fragment.primitive_id, original.primitive_id);
    LaneMask lanes = 0xfu << (4 * to);
    for (std::size_t q = 0; q < kWarpQuads; ++q)
      if (random() % 3 != 0) lanes |= 0xfu << (4 * q);
    for (std::size_t q = 0; q < kWarpQuads; ++q)
      g.fragment.varyings[q] = g.planes[q == to ? from : random() % kWarpQuads].data();
    g.run(program, lanes);
    INFO(disassemble(program));
    for (std::size_t lane = 0; lane < 4; ++lane) {
      for (std::size_t slot = 0; slot < kFragmentOutputs; ++slot)
        REQUIRE(g.outputs[slot][4 * to + lane] == outputs[slot][4 * from + lane]);
      for (std::size_t r = 0; r < regs.size(); ++r)
        REQUIRE(g.warp.regs[r][4 * to + lane] == regs[r][4 * from + lane]);
    }
    REQUIRE(((g.warp.killed >> (4 * to)) & 0xfu) == ((killed >> (4 * from)) & 0xfu));
  }
}

TEST_CASE("shader lanes: without quad operations, a lane's values do not depend on any other lane") {
  std::mt19937 random(12);
  for (int round = 0; round < 100; ++round) {
    const Program program = random_program(random, {.quad_operations = false});
    WarpFixture f, g;
    f.run(program);
    const LaneMask lanes = static_cast<LaneMask>(random());
    g.run(program, lanes);
    INFO(disassemble(program));
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      if (((lanes >> lane) & 1u) == 0) continue;
      for (std::size_t r = 0; r < f.warp.regs.size(); ++r)
        REQUIRE(g.warp.regs[r][lane] == f.warp.regs[r][lane]);
    }
    REQUIRE(g.warp.killed == (f.warp.killed & lanes));
  }
}

TEST_CASE("shader program: a copy is prepared anew, so a changed copy runs its own code") {
  WarpFixture f;
  const Program original = textured("mov r0, 1\n");
  f.run(original);
  Program changed = original;
  changed.code[0] = {};
  f.run(changed);
  CHECK(f.warp.regs[0][0] == 0);
  f.run(original);
  CHECK(f.warp.regs[0][0] == 1);
}

}  // namespace quadrille::models::test
