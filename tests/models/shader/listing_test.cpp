/// The listing: reads back what was printed, and names the line of a mistake.
#include "models/base/error.h"
#include "tests/models/shader/random_program.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>

namespace quadrille::models::test {
namespace {

std::string error_of(const std::string& text) {
  try {
    (void)assemble(text, "shader");
  } catch (const UserError& error) { return error.what(); }
  return "no error";
}

}  // namespace

TEST_CASE("listing: assembling a disassembled random program gives the same program") {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Program program = random_program(random, {});
    const std::string text = disassemble(program);
    const Program again = assemble(text, program.name);
    INFO(text);
    REQUIRE(again == program);
    REQUIRE(disassemble(again) == text);
  }
}

TEST_CASE("listing: a vertex program with every directive reads back") {
  const Program p = assemble(
      ".stage vertex\n.regs 9\n.push c0 offset=64 words=16\n.uniform c16 set=2 binding=5 offset=32 "
      "words=4\n.literal c20 0.5 -1 0xffc00001 "
      "1e-30\n.constants 40\n"
      ".texture set=1 binding=3\n.texture set=1 binding=4 uint\n.color location=2 sint\n.input location=4 "
      "component=2\n.varying flat\n.varying linear\n"
      "input r0, in0\ninput r1, vertex_index\noutput out0, r0\noutput out5, -|c20|\ntexlod r2, t0, r0, r1, "
      "0.0\nend",
      "vertex");
  CHECK(p.num_regs == 9);
  CHECK(p.constants.words == 41);  // the number 0.0 is a word of its own, behind the declared ones
  CHECK(p.constants.ranges[1].binding == 5);
  CHECK(p.constants.ranges[2].literals ==
        std::vector<std::uint32_t>{bits_of(0.5f), ~0u, 0xffc00001u, bits_of(1e-30f)});
  CHECK(p.textures[0] == TextureBinding{1, 3});
  CHECK(p.textures[1] == TextureBinding{1, 4, NumberKind::kUint});
  CHECK(p.color_kinds[2] == NumberKind::kSint);
  CHECK(assemble(".extras point_size=1 clip=2 cull=0 viewport=1\nend\n", "vertex").extras.count() == 4);
  CHECK(p.vertex_inputs[0] == VertexInputUse{4, 2});
  CHECK(p.varyings == std::vector<Interpolation>{Interpolation::kFlat, Interpolation::kLinear});
  CHECK(assemble(disassemble(p), "vertex") == p);
}

TEST_CASE("listing: every literal word reads back") {
  std::mt19937 random(4);
  std::vector<std::uint32_t> words = special_words();
  for (int i = 0; i < 5000; ++i) words.push_back(random_word(random));
  Program p = assemble("end\n", "literals");
  p.constants.words = static_cast<std::uint32_t>(words.size());
  p.constants.ranges.push_back({.words = p.constants.words, .literals = words});
  CHECK(assemble(disassemble(p), "literals").constants.ranges[0].literals == words);
}

TEST_CASE("listing: equal numbers share a word, and the value of a literal is shown") {
  const Program p = assemble("fadd r0, 0.25, 0.25\nfmul r1, r0, 3\nend\n", "numbers");
  CHECK(p.constants.words == 2);
  CHECK(p.code[0].a == p.code[0].b);
  CHECK(p.num_regs == 2);
  CHECK(disassemble(p).find("c0 = 0.25") != std::string::npos);
}

TEST_CASE("listing: a mistake is reported with its line") {
  const auto starts = [](const std::string& text, const std::string& prefix) {
    const std::string error = error_of(text);
    INFO(error);
    CHECK(error.rfind(prefix, 0) == 0);
  };
  starts("; comment\n\nfrob r0, r1\nend\n", "shader:3: unknown operation 'frob'");
  starts("fadd r0, r1\nend\n", "shader:1: 'fadd' takes 3 operands, 2 given");
  starts("fadd c0, r1, r1\nend\n", "shader:1: the destination must be a register");
  starts("fadd r0, r1, q7\nend\n", "shader:1: 'q7' is no operand");
  starts(".colour\nend\n", "shader:1: unknown directive");
  starts(".texture set=0 binding=0 short\nend\n", "shader:1: 'short' is none of: float uint sint; 2d 1d 3d");
  starts(".color location=8 uint\nend\n", "shader:1: location is 8; legal: at most 7");
  starts(".stage geometry\nend\n", "shader:1: stage must be one of: vertex fragment");
  starts(".extras point_size=0 clip=0 cull=0 viewport=2\nend\n", "shader:1: viewport is 2; legal: at most 1");
  starts(".varying smooth\nend\n", "shader:1: interpolation must be one of");
  starts(".flags fast\nend\n", "shader:1: unknown flag 'fast'");
  starts(".texture set=0\nend\n", "shader:1: expected 'binding=NUMBER'");
  starts(".literal c0 1.5x\nend\n", "shader:1: '1.5x' is not a number");
  starts(".push c9999999999 offset=0 words=1\nend\n", "shader:1: expected the first constant word");
  starts(".push c60000 offset=0 words=60000\nend\n", "shader:1: the range ends at word 120000");
  starts(".regs 999\nend\n", "shader:1: expected one number from 0 to 256");
  starts(".regs 2\nmov r0, r1\nmov r2, r1\nend\n", "shader:3: 'mov' writes r2");
  starts("mov r0, c3\nend\n", "shader:1: operand a is c3");
  starts("iadd r0, -r1, r1\nend\n", "shader:1: operand a of 'iadd' takes no modifier");
  starts("iadd.sat r0, r1, r1\nend\n", "shader:1: 'iadd' cannot saturate");
  starts("interp r0, vary0\nend\n", "shader:1: varying 0 does not exist");
  starts(".stage vertex\nkillif r0\nend\n", "shader:2: 'killif' exists only in fragment shaders");
  starts(".stage fragment\ninput r0, vertex_index\nend\n", "shader:2: system value");
  starts(".stage fragment\noutput out34, r0\nend\n", "shader:2: output slot 34");
  starts("if r0\nloop\nendif\nendloop\nend\n", "shader:3: 'endif' does not end");
  starts("if r0\nend\n", "shader:2: 'end' inside an open 'if'");
  starts("if r0\nelse\nelse\nendif\nend\n", "shader:3: 'else' has no 'if'");
  starts("loop\nif r0\ncontinuing\nendif\nendloop\nend\n", "shader:3: 'continuing' has no 'loop'");
  starts("breakif r0\nend\n", "shader:1: 'breakif' is outside a loop");
  starts("mov r0, r0\n", "shader:1: the last instruction is 'mov'");
  starts("end\nend\n", "shader:1: 'end' before");
  starts("", "shader:0: there are no instructions");
  starts("loadconst r0, c0, r1, r2\nend\n", "shader:1: operand b of 'loadconst' must be a literal");
  starts("loadconst r0, c0, r1, 9\nend\n", "shader:1: 'loadconst' reaches c[0 + 9]");
  std::string deep;
  for (int i = 0; i <= kMaxControlDepth; ++i) deep += "if r0\n";
  starts(deep, "shader:33: control flow nests deeper than 32");
}

TEST_CASE("listing: docs/isa.md has a row for every operation, and its example assembles") {
  std::ifstream file(QUADRILLE_SOURCE_DIR "/docs/isa.md");
  std::string page((std::istreambuf_iterator<char>(file)), {});
  const std::string rows = page.substr(0, page.find("## Control flow"));
  for (int op = 0; op < static_cast<int>(Op::kCount); ++op) {
    INFO(op_name(static_cast<Op>(op)));
    CHECK(rows.find("`" + std::string(op_name(static_cast<Op>(op))) + "`") != std::string::npos);
  }
  const std::size_t begin = page.find("```\n") + 4;
  const Program example =
      assemble(std::string_view(page).substr(begin, page.find("```", begin) - begin), "example");
  CHECK(example.code.size() == 13);
}

TEST_CASE("listing: text of random characters is an error and nothing worse") {
  std::mt19937 random(5);
  const std::string alphabet = "rc0123456789.,-|; \n\tfadmovtexifendlp=";
  for (int i = 0; i < 3000; ++i) {
    std::string text;
    for (std::size_t n = random() % 60; n > 0; --n) text += alphabet[random() % alphabet.size()];
    CHECK_THROWS_AS(assemble(text + "\n?", "noise"), UserError);
  }
}

}  // namespace quadrille::models::test
