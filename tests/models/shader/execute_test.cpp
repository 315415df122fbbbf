/// Execution of whole programs: control flow and its masks, interface operations, clauses and their cost,
/// helper lanes.
#include "models/base/error.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

#include <bitset>

namespace quadrille::models::test {
namespace {

Program fragment(const std::string& code) { return assemble(".stage fragment\n" + code + "end\n", "test"); }

/// Lane numbers in r0: primitive_id is lane / 4 and frag_coord_x lane + 1/2 in the fixture.
const std::string kLaneNumber = "input r0, frag_coord_x\nf2i r0, r0\n";

/// Checks register `r` of every lane against a function of the lane number.
template <class Expected>
void check_lanes(const WarpFixture& f, std::size_t r, Expected expected) {
  for (std::uint32_t lane = 0; lane < kWarpLanes; ++lane) {
    INFO("lane " << lane);
    CHECK(f.warp.regs[r][lane] == static_cast<std::uint32_t>(expected(lane)));
  }
}

}  // namespace

TEST_CASE("shader control: nested if and else take each lane through its own side") {
  WarpFixture f;
  f.run(fragment(
      kLaneNumber +
      "ult r1, r0, 16\nif r1\n  and r2, r0, 1\n  if r2\n    mov r3, 1\n  else\n    mov r3, 2\n  endif\n  "
      "iadd r4, r3, 10\n"
      "else\n  ult r2, r0, 20\n  if r2\n    mov r3, 3\n  endif\n  mov r4, 30\nendif\niadd r4, r4, 100\n"));
  check_lanes(f, 3, [](std::uint32_t i) { return i < 16 ? (i % 2 != 0 ? 1 : 2) : i < 20 ? 3 : 0; });
  check_lanes(f, 4, [](std::uint32_t i) { return i < 16 ? (i % 2 != 0 ? 111 : 112) : 130; });
  CHECK(f.warp.exec == ~0u);
  CHECK(f.warp.control_depth == 0);
}

TEST_CASE("shader control: a loop runs each lane its own number of times") {
  WarpFixture f;
  f.run(fragment(kLaneNumber + "mov r1, 0\nmov r2, 0\nloop\n  ule r3, r0, r1\n  breakif r3\n  iadd r2, r2, "
                               "r1\n  iadd r1, r1, 1\nendloop\nmov r4, 5\n"));
  check_lanes(f, 2, [](std::uint32_t i) { return i * (i - 1) / 2; });
  check_lanes(f, 4, [](std::uint32_t) { return 5; });
}

TEST_CASE("shader control: continue skips the rest of the body, not the continue block") {
  WarpFixture f;
  // Sum of the odd numbers below the lane number; the step is behind CONTINUING, inside an IF nest the
  // continue leaves.
  f.run(fragment(kLaneNumber + "mov r1, 0\nmov r2, 0\nloop\n  ule r3, r0, r1\n  breakif r3\n  and r4, r1, "
                               "1\n  ieq r4, r4, 0\n  if r4\n    "
                               "continueif r4\n    mov r2, 9999\n"
                               "  endif\n  iadd r2, r2, r1\n  continuing\n  iadd r1, r1, 1\nendloop\n"));
  check_lanes(f, 2, [](std::uint32_t i) { return (i / 2) * (i / 2); });
}

TEST_CASE("shader control: without a continue block, continued lanes rejoin at the end of the loop") {
  WarpFixture f;
  f.run(fragment(
      kLaneNumber +
      "mov r1, 0\nmov r2, 0\nloop\n  iadd r1, r1, 1\n  ult r3, r0, r1\n  breakif r3\n  and r4, r1, 1\n  "
      "continueif r4\n  iadd r2, r2, 1\nendloop\n"));
  check_lanes(f, 2, [](std::uint32_t i) { return i / 2; });  // even numbers in 1..i
}

TEST_CASE("shader control: nested loops break only the inner one") {
  WarpFixture f;
  f.run(fragment(
      kLaneNumber +
      "mov r1, 0\nmov r5, 0\nloop\n  ule r3, 3, r1\n  breakif r3\n  mov r2, 0\n  loop\n    ule r3, r0, r2\n  "
      "  if "
      "r3\n      breakif r3\n    else\n"
      "      iadd r5, r5, 1\n    endif\n    iadd r2, r2, 1\n  endloop\n  iadd r1, r1, 1\nendloop\n"));
  check_lanes(f, 5, [](std::uint32_t i) { return 3 * i; });
}

TEST_CASE("shader control: a loop without an end is the user's mistake") {
  WarpFixture f;
  const Program p = fragment("loop\n  iadd r0, r0, 1\nendloop\n");
  CHECK_THROWS_WITH(f.run(p), Catch::Contains("'test'") && Catch::Contains("1048576 iterations"));
}

TEST_CASE("shader control: a loop of a long body without an end is given up after fewer rounds") {
  WarpFixture f;
  std::string body;
  for (int i = 0; i < 1000; ++i) body += "  iadd r0, r0, 1\n";
  const Program p = fragment("loop\n" + body + "endloop\n");
  CHECK_THROWS_WITH(f.run(p), Catch::Contains("'test'") && Catch::Contains("67109000 instructions"));
}

TEST_CASE("shader control: a side that no lane takes is jumped over and not charged") {
  WarpFixture f;
  const ClauseCost cost = f.run(fragment(
      "if 0\n  fadd r0, r0, r0\n  fadd r0, r0, r0\n  fadd r0, r0, r0\nelse\n  frcp r1, r1\nendif\n"));
  CHECK(cost.alu == 0);
  CHECK(cost.sfu == 1);
  CHECK(cost.control == 4);        // if, else, endif, end
  CHECK(cost.lane_ops == 32 * 4);  // the else is met with no lane
}

TEST_CASE("shader control: both sides of a divided warp are charged with their lanes") {
  WarpFixture f;
  const ClauseCost cost =
      f.run(fragment(kLaneNumber + "ult r1, r0, 5\nif r1\n  fadd r2, r2, r2\n  fadd r2, r2, r2\nelse\n  fsin "
                                   "r2, r2\nendif\noutput out0, r2\n"));
  CHECK(cost.alu == 5);
  CHECK(cost.sfu == 1);
  CHECK(cost.exported == 1);
  CHECK(cost.control == 4);
  CHECK(cost.lane_ops == 3 * 32 + 32 + 2 * 5 + 5 + 27 + 27 + 32 + 32);
  CHECK(cost.instructions() == 11);
}

TEST_CASE("shader control: discarded lanes go on as helpers, also out of an if") {
  WarpFixture f;
  f.run(fragment(
      kLaneNumber +
      "ult r1, r0, 8\nif r1\n  and r2, r0, 1\n  killif r2\n  mov r3, 7\nendif\nddxfine r4, r3\nmov r5, 1\n"));
  CHECK(f.warp.killed == 0xaau);
  CHECK(f.warp.exec == ~0u);
  check_lanes(f, 3, [](std::uint32_t i) { return i < 8 ? 7 : 0; });
  check_lanes(f, 5, [](std::uint32_t) { return 1; });
  f.run(fragment("killif 1\n"), 0xf0u);
  CHECK(f.warp.killed == 0xf0u);
}

TEST_CASE("shader control: a warp without lanes ends at once and costs nothing") {
  WarpFixture f;
  const ClauseCost cost = f.run(fragment("loop\nendloop\n"), 0);
  CHECK(cost.instructions() == 0);
  CHECK(f.clauses == 1);
}

TEST_CASE("shader interface: inputs, system values and outputs reach their rows") {
  WarpFixture f;
  f.run(assemble(".stage vertex\n.input location=0 component=0\n.input location=0 component=1\n.varying "
                 "flat\ninput r0, in1\ninput r1, "
                 "vertex_index\n"
                 "input r2, instance_index\noutput out0, r0\noutput out4, r1\noutput out3, -|r2|\nend\n",
                 "vertex"),
        0x0000ff0fu);
  for (std::uint32_t i = 0; i < kWarpLanes; ++i) {
    const bool written = ((0x0000ff0fu >> i) & 1u) != 0;
    CHECK(f.outputs[0][i] == (written ? 1000 + i : 0u));
    CHECK(f.outputs[4][i] == (written ? 100 + i : 0u));
    CHECK(f.outputs[3][i] == (written ? 0x80000000u | (7 * i) : 0u));
  }
  f.run(
      fragment("input r0, frag_coord_y\ninput r1, frag_coord_z\ninput r2, frag_coord_w\ninput r3, "
               "front_facing\ninput r4, primitive_id\n"));
  check_lanes(f, 0, [&](std::uint32_t i) { return bits_of(f.fragment.y[i]); });
  check_lanes(f, 1, [&](std::uint32_t i) { return bits_of(f.fragment.z[i]); });
  check_lanes(f, 2, [&](std::uint32_t i) { return bits_of(f.fragment.inv_w[i]); });
  check_lanes(f, 3, [&](std::uint32_t i) { return f.fragment.front_facing[i]; });
  check_lanes(f, 4, [&](std::uint32_t i) { return f.fragment.primitive_id[i]; });
  f.run(fragment(
      "input r0, sample_id\ninput r1, sample_x\ninput r2, sample_y\ninput r3, sample_mask\noutput out33, "
      "r3\n"));
  check_lanes(f, 0, [&](std::uint32_t i) { return f.fragment.sample_id[i]; });
  check_lanes(f, 1, [&](std::uint32_t i) { return bits_of(f.fragment.sample_x[i]); });
  check_lanes(f, 2, [&](std::uint32_t i) { return bits_of(f.fragment.sample_y[i]); });
  check_lanes(f, 3, [&](std::uint32_t i) { return f.fragment.sample_mask[i]; });
  CHECK(f.outputs[kSampleMaskOutput] == f.fragment.sample_mask);
}

TEST_CASE("shader interface: interpolation by mode, for one triangle and for eight") {
  for (const bool one_triangle : {false, true})
    for (const bool masked : {false, true}) {
      WarpFixture f;
      if (one_triangle) f.fragment.varyings.fill(f.planes[3].data());
      const std::string body =
          "interp r1, vary0\ninterp r2, vary1\ninterp r3, vary2\ninterp r5, vary3\ninterp r6, vary4\n";
      f.run(
          fragment(".varying perspective\n.varying linear\n.varying flat\n.varying perspective-centroid\n"
                   ".varying linear-centroid\n" +
                   kLaneNumber + (masked ? "ult r4, r0, 13\nif r4\n" + body + "endif\n" : body)));
      const auto plane = [&](std::uint32_t lane, std::size_t slot, const LaneFloats& w1,
                             const LaneFloats& w2) {
        const float* v = f.fragment.varyings[lane / 4] + 3 * slot;
        const volatile float p1 = w1[lane] * v[1], p2 = w2[lane] * v[2], sum = v[0] + p1;
        return masked && lane >= 13 ? 0u : bits_of(sum + p2);
      };
      check_lanes(f, 1, [&](std::uint32_t i) { return plane(i, 0, f.fragment.persp_1, f.fragment.persp_2); });
      check_lanes(f, 2,
                  [&](std::uint32_t i) { return plane(i, 1, f.fragment.linear_1, f.fragment.linear_2); });
      check_lanes(f, 3, [&](std::uint32_t i) {
        return masked && i >= 13 ? 0u : bits_of(f.fragment.varyings[i / 4][6]);
      });
      check_lanes(f, 5, [&](std::uint32_t i) {
        return plane(i, 3, f.fragment.centroid_persp_1, f.fragment.centroid_persp_2);
      });
      check_lanes(f, 6, [&](std::uint32_t i) {
        return plane(i, 4, f.fragment.centroid_linear_1, f.fragment.centroid_linear_2);
      });
    }
}

TEST_CASE("shader interface: indexed constants are clamped at both ends") {
  WarpFixture f;
  f.run(fragment(".literal c0 10 11 12 13 14\n" + kLaneNumber +
                 "isub r0, r0, 4\nloadconst r1, c1, r0, 2\nloadconst r2, c1, 1, 2\n"));
  check_lanes(f, 1, [](std::uint32_t i) { return i < 4 ? 11 : i > 6 ? 13 : 11 + (i - 4); });
  check_lanes(f, 2, [](std::uint32_t) { return 12; });
}

TEST_CASE("shader interface: texture sizes by level, the level clamped to those that exist") {
  WarpFixture f;
  f.sizes[1] = {640, 5, 4};
  f.run(fragment(".texture set=0 binding=0\n.texture set=0 binding=1\n" + kLaneNumber +
                 "isub r0, r0, 1\ntexsize r2, t1, r0\n"));
  const auto level = [](std::uint32_t i) { return i == 0 ? 0u : std::min(i - 1, 3u); };
  check_lanes(f, 2, [&](std::uint32_t i) { return 640u >> level(i); });
  check_lanes(f, 3, [&](std::uint32_t i) { return std::max(5u >> level(i), 1u); });
}

TEST_CASE("shader interface: derivatives in a quad, whatever the mask") {
  for (const bool masked : {false, true}) {
    WarpFixture f;
    const std::string body = "ddxfine r2, r1\nddyfine r3, r1\nddxcoarse r4, r1\nddycoarse r5, r1\n";
    // r1 = lane^2; only lane 3 of each quad executes when masked.
    f.run(fragment(kLaneNumber + "i2f r1, r0\nfmul r1, r1, r1\nand r6, r0, 3\nieq r6, r6, 3\n" +
                   (masked ? "if r6\n" + body + "endif\n" : body)));
    const auto square = [](std::uint32_t i) { return static_cast<float>(i * i); };
    const auto check = [&](std::size_t r, auto from, auto to) {
      check_lanes(f, r, [&](std::uint32_t i) {
        return masked && i % 4 != 3 ? 0u : bits_of(square(to(i)) - square(from(i)));
      });
    };
    check(
        2, [](std::uint32_t i) { return i & ~1u; }, [](std::uint32_t i) { return i | 1u; });
    check(
        3, [](std::uint32_t i) { return i & ~2u; }, [](std::uint32_t i) { return i | 2u; });
    check(
        4, [](std::uint32_t i) { return i & ~3u; }, [](std::uint32_t i) { return (i & ~3u) + 1; });
    check(
        5, [](std::uint32_t i) { return i & ~3u; }, [](std::uint32_t i) { return (i & ~3u) + 2; });
  }
}

}  // namespace quadrille::models::test
