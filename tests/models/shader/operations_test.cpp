/// Every operation against the scalar model: all operand kinds, modifiers, saturation, masked and unmasked,
/// destination equal to a source.
#include "models/base/error.h"
#include "models/shader/op_table.h"
#include "tests/models/shader/scalar_model.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

namespace quadrille::models::test {
namespace {

constexpr std::uint16_t kCondition = 3, kResult = 4;

/// `instruction`, alone or inside an IF on r3.
Program single(const Instruction& instruction, bool masked) {
  Program p;
  p.stage = ShaderStage::kFragment;
  p.name = "single";
  p.num_regs = 5;
  p.constants.words = 3;
  const Operand condition{Operand::kRegister, 0, kCondition};
  if (masked) p.code.push_back({.op = Op::kIf, .a = condition});
  p.code.push_back(instruction);
  if (masked) p.code.push_back({.op = Op::kEndIf});
  p.code.push_back({.op = Op::kEnd});
  return p;
}

/// One form of an operation: constants by bit, modifiers of each operand, saturation, destination.
struct Form {
  unsigned constants = 0;
  std::array<std::uint8_t, 3> modifiers{};
  bool saturate = false, masked = false;
  std::uint16_t dst = kResult;
};

Instruction instruction_of(Op op, const Form& form) {
  Instruction in;
  in.op = op;
  in.dst = form.dst;
  in.flags = form.saturate ? Instruction::kSaturate : 0;
  Operand* const operands[] = {&in.a, &in.b, &in.c};
  for (unsigned i = 0; i < op_info(op).sources; ++i) {
    const bool constant = ((form.constants >> i) & 1u) != 0;
    *operands[i] = {constant ? Operand::kConstant : Operand::kRegister, form.modifiers[i],
                    static_cast<std::uint16_t>(i)};
  }
  return in;
}

bool acceptable(Op op, std::uint32_t got, std::uint32_t wanted) {
  if (got == wanted) return true;
  if (allowed_ulps(op) > 0) return ulps_between(got, wanted) <= allowed_ulps(op);
  return has_float_result(op) && is_nan(got) && is_nan(wanted);
}

/// Runs one form on random words and counts lanes that differ from the scalar model.
int wrong_lanes(Op op, const Form& form, std::mt19937& random, WarpFixture& f, std::string& first) {
  const Program program = single(instruction_of(op, form), form.masked);
  f.constants = {random_word(random), random_word(random), random_word(random)};
  f.warp.launch(program, f.constants.data(), ~0u);
  for (auto& row : f.warp.regs)
    for (auto& word : row) word = random_word(random);
  const LaneMask exec = form.masked ? static_cast<LaneMask>(random()) | 1u : ~0u;
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) f.warp.regs[kCondition][lane] = (exec >> lane) & 1u;
  const auto before = f.warp.regs;
  f.finish();
  int wrong = 0;
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    std::array<std::uint32_t, 3> x{};
    for (unsigned i = 0; i < 3; ++i)
      x[i] = scalar_modified(((form.constants >> i) & 1u) != 0 ? f.constants[i] : before[i][lane],
                             form.modifiers[i]);
    std::uint32_t wanted = scalar_result(op, x[0], x[1], x[2]);
    if (form.saturate) wanted = scalar_saturated(wanted);
    if (((exec >> lane) & 1u) == 0) wanted = before[form.dst][lane];
    const std::uint32_t got = f.warp.regs[form.dst][lane];
    if (acceptable(op, got, wanted)) continue;
    if (wrong++ == 0)
      first = fmt::format("{} lane {}: {:#x} {:#x} {:#x} gives {:#x}, wanted {:#x}", disassemble(program),
                          lane, x[0], x[1], x[2], got, wanted);
  }
  return wrong;
}

std::vector<Form> forms_of(Op op, std::mt19937& random) {
  const OpInfo& info = op_info(op);
  std::vector<Form> forms;
  for (unsigned constants = 0; constants < (1u << info.sources); ++constants)
    for (const bool modified : {false, true})
      for (const bool saturate : {false, true})
        for (const bool masked : {false, true}) {
          if ((modified && info.modifiable == 0) || (saturate && !info.saturable)) continue;
          Form form{constants, {}, saturate, masked, random() % 2 == 0 ? kResult : std::uint16_t{0}};
          for (unsigned i = 0; i < info.sources; ++i)
            if (modified && ((info.modifiable >> i) & 1u) != 0)
              form.modifiers[i] = static_cast<std::uint8_t>(random() % 4);
          forms.push_back(form);
        }
  return forms;
}

}  // namespace

TEST_CASE("shader operations: every form of every operation agrees with the scalar model") {
  std::mt19937 random(1);
  WarpFixture f;
  for (int number = 0; number < static_cast<int>(Op::kCount); ++number) {
    const Op op = static_cast<Op>(number);
    if (!has_scalar_model(op)) continue;
    std::string first;
    int wrong = 0, forms = 0;
    for (int round = 0; round < 40; ++round)
      for (const Form& form : forms_of(op, random)) wrong += wrong_lanes(op, form, random, f, first), ++forms;
    INFO(op_name(op) << ": " << first);
    CHECK(wrong == 0);
    CHECK(forms > 0);
  }
}

TEST_CASE("shader operations: every pair of special words agrees with the scalar model") {
  WarpFixture f;
  const auto& words = special_words();
  for (int number = 0; number < static_cast<int>(Op::kCount); ++number) {
    const Op op = static_cast<Op>(number);
    if (!has_scalar_model(op) || source_count(op) == 3) continue;
    const Program program =
        single(instruction_of(op, {.constants = 2u & ((1u << source_count(op)) - 1)}), false);
    f.constants.assign(3, 0);
    for (const std::uint32_t b : words)
      for (std::size_t base = 0; base < words.size(); base += kWarpLanes) {
        f.constants[1] = b;
        f.warp.launch(program, f.constants.data(), ~0u);
        for (std::size_t lane = 0; lane < kWarpLanes; ++lane)
          f.warp.regs[0][lane] = words[(base + lane) % words.size()];
        f.finish();
        for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
          const std::uint32_t a = words[(base + lane) % words.size()];
          if (acceptable(op, f.warp.regs[kResult][lane], scalar_result(op, a, b, 0))) continue;
          FAIL_CHECK(fmt::format("{} {:#x} {:#x} gives {:#x}, wanted {:#x}", op_name(op), a, b,
                                 f.warp.regs[kResult][lane], scalar_result(op, a, b, 0)));
        }
      }
  }
}

TEST_CASE("shader operations: documented edge results") {
  WarpFixture f;
  const auto result = [&](const std::string& code) {
    f.run(assemble(".stage fragment\n" + code + "\nend\n", "edge"));
    return f.warp.regs[0][13];
  };
  CHECK(result("idiv r0, 0x80000000, -1") == 0x80000000u);
  CHECK(result("irem r0, 0x80000000, -1") == 0u);
  CHECK(result("idiv r0, 7, 0") == ~0u);
  CHECK(result("udiv r0, 7, 0") == ~0u);
  CHECK(result("imod r0, -7, 3") == 2u);
  CHECK(result("irem r0, -7, 3") == static_cast<std::uint32_t>(-1));
  CHECK(result("imod r0, -7, 0") == static_cast<std::uint32_t>(-7));
  CHECK(result("shl r0, 1, 33") == 2u);
  CHECK(result("f2i r0, nan") == 0u);
  CHECK(result("f2i r0, 3e9") == 0x7fffffffu);
  CHECK(result("f2u r0, -1.0") == 0u);
  CHECK(result("fmin r0, nan, 2.0") == bits_of(2.0f));
  CHECK(result("fmax r0, 2.0, nan") == bits_of(2.0f));
  CHECK(result("fadd.sat r0, nan, 1.0") == 0u);
  CHECK(result("mov r0, -0.0") == 0x80000000u);
  CHECK(result("fmul r0, 0x00000003, 0.5") == 2u);  // denormals are kept: 1.5 rounds to even
  CHECK(result("flog2 r0, 0.0") == 0xff800000u);
  CHECK(is_nan(result("flog2 r0, -1.0")));
  CHECK(result("fexp2 r0, 128.0") == 0x7f800000u);
  CHECK(result("fexp2 r0, -149.0") == 1u);
  CHECK(result("fsin r0, -0.0") == 0x80000000u);
  CHECK(is_nan(result("fcos r0, inf")));
}

TEST_CASE("shader operations: fmad rounds twice and ffma once") {
  WarpFixture f;
  // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24: the last term is lost when the product is rounded.
  f.run(
      assemble(".stage fragment\nfmad r0, 1.000244140625, 1.000244140625, -1.00048828125\nffma r1, "
               "1.000244140625, 1.000244140625, "
               "-1.00048828125\nend\n",
               "mad"));
  CHECK(f.warp.regs[0][0] == 0u);
  CHECK(as_float(f.warp.regs[1][0]) == 0x1p-24f);
}

TEST_CASE(
    "shader operations: of two NaN operands the first one's bits go on in every form, so that a lane does "
    "not see who shares its warp") {
  WarpFixture f;
  for (const Op op : {Op::kFAdd, Op::kFMul})
    for (unsigned constants = 0; constants < 4; ++constants)
      for (const bool masked : {false, true}) {
        const Program program = single(instruction_of(op, {.constants = constants}), masked);
        f.constants = {0x7fc00001u, 0xffc00002u, 0};
        f.warp.launch(program, f.constants.data(), ~0u);
        f.warp.regs[0].fill(0x7fc00001u);
        f.warp.regs[1].fill(0xffc00002u);
        f.warp.regs[kCondition].fill(0);
        f.warp.regs[kCondition][9] = 1;
        f.finish();
        INFO(disassemble(program));
        CHECK(f.warp.regs[kResult][9] == 0x7fc00001u);
      }
}

}  // namespace quadrille::models::test
