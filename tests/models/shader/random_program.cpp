/// The generator of random programs.
#include "tests/models/shader/random_program.h"

#include "models/shader/op_table.h"
#include "tests/models/shader/warp_fixture.h"

namespace quadrille::models::test {
namespace {

/// random destinations and sources; above them: loop counters, conditions, and room for textures
constexpr std::uint16_t kRegisters = 24;
constexpr std::uint16_t kFirstCounter = 28;  ///< one a nesting level
constexpr std::uint16_t kCondition = 27;
constexpr int kMaxNesting = 5;
constexpr std::uint16_t kLastIndex = 0, kOne = 1, kTrips = 2, kFirstRandom = 3;  ///< literal words

class Generator {
 public:
  Generator(std::mt19937& random, const RandomProgramOptions& options) : random_(random), options_(options) {}

  Program generate() {
    header();
    statements(options_.statements);
    for (std::uint16_t slot = 0; slot < kFragmentOutputs; ++slot) {
      Instruction in = make(Op::kOutput);
      in.imm = slot;
      program_.code.push_back(in);
    }
    program_.code.push_back(make(Op::kEnd));
    return program_;
  }

 private:
  [[nodiscard]] std::uint16_t below(std::size_t n) { return static_cast<std::uint16_t>(random_() % n); }

  void header() {
    program_.stage = ShaderStage::kFragment;
    program_.name = "random";
    program_.num_regs = kFirstCounter + kMaxNesting;
    program_.uses_discard = below(2) != 0;
    program_.writes_depth = true;
    program_.writes_sample_mask = true;
    program_.by_sample = below(2) != 0;
    program_.early_fragment_tests = below(2) != 0;
    program_.uses_derivatives = options_.quad_operations;
    for (int i = 0; i < 6; ++i) program_.varyings.push_back(static_cast<Interpolation>(below(5)));
    for (std::uint32_t i = 0; i < 3; ++i) program_.textures.push_back({i, below(9)});
    ConstantLayout::Range literals{.words = 12, .literals = {7, 1, 1u + below(4)}};
    while (literals.literals.size() < literals.words) literals.literals.push_back(random_word(random_));
    program_.constants.ranges = {literals,
                                 {.source = ConstantLayout::Source::kPushConstant,
                                  .byte_offset = 16,
                                  .first_word = 12,
                                  .words = 4,
                                  .literals = {}},
                                 {.source = ConstantLayout::Source::kUniformBlock,
                                  .set = 1,
                                  .binding = 2,
                                  .first_word = 16,
                                  .words = 8,
                                  .literals = {}}};
    program_.constants.words = 24;
  }

  Operand source(bool may_modify) {
    Operand operand;
    operand.kind = below(4) == 0 ? Operand::kConstant : Operand::kRegister;
    operand.index = operand.kind == Operand::kConstant
                        ? static_cast<std::uint16_t>(kFirstRandom + below(24 - kFirstRandom))
                        : below(kRegisters);
    if (may_modify && below(3) == 0) operand.modifiers = static_cast<std::uint8_t>(below(4));
    return operand;
  }

  Instruction make(Op op) {
    const OpInfo& info = op_info(op);
    Instruction in;
    in.op = op;
    if (info.destinations != 0) in.dst = below(kRegisters);
    if (info.saturable && below(5) == 0) in.flags = Instruction::kSaturate;
    Operand* const operands[] = {&in.a, &in.b, &in.c};
    for (unsigned i = 0; i < info.sources; ++i) *operands[i] = source(((info.modifiable >> i) & 1u) != 0);
    if (info.immediate == Immediate::kVaryingSlot) in.imm = below(program_.varyings.size());
    if (info.immediate == Immediate::kTextureBinding) in.imm = below(program_.textures.size());
    if (info.immediate == Immediate::kInputSlot)
      in.imm = static_cast<std::uint16_t>(static_cast<std::uint16_t>(SystemValue::kFragCoordX) + below(12));
    if (info.immediate == Immediate::kConstantWord) {
      in.imm = below(16);
      in.b = {Operand::kConstant, 0, kLastIndex};
    }
    return in;
  }

  [[nodiscard]] bool allowed(Op op) const {
    const bool quad =
        (op >= Op::kDdxFine && op <= Op::kDdyCoarse) || op == Op::kTexImplicit || op == Op::kTexBias;
    return op != Op::kOutput && op_info(op).immediate != Immediate::kTextureOperation &&
           op_info(op).immediate != Immediate::kBufferBinding &&
           (issue_class(op) != IssueClass::kControl || op == Op::kKillIf) &&
           (options_.quad_operations || !quad);
  }

  void straight() {
    Op op = static_cast<Op>(below(static_cast<std::size_t>(Op::kCount)));
    if (below(5) == 0) op = Op::kTexLod;
    while (!allowed(op)) op = static_cast<Op>(below(static_cast<std::size_t>(Op::kCount)));
    program_.code.push_back(make(op));
  }

  /// A comparison of random values, true in some lanes.
  Operand condition() {
    Instruction compare = make(below(2) != 0 ? Op::kFLt : Op::kILt);
    compare.dst = kCondition;
    program_.code.push_back(compare);
    return {Operand::kRegister, 0, kCondition};
  }

  void leave(Op op) {
    Instruction in;
    in.a = condition();
    in.op = op;
    program_.code.push_back(in);
  }

  void statements(int count) {
    for (int i = 0; i < count; ++i) {
      const bool nest = options_.control_flow && nesting_ < kMaxNesting && below(8) == 0;
      if (!nest) straight();
      else if (below(2) == 0) branch(count / 3);
      else loop(count / 3);
      if (loops_ > 0 && below(10) == 0) leave(below(2) != 0 ? Op::kBreakIf : Op::kContinueIf);
    }
  }

  void plain(Op op) {
    Instruction in;
    in.op = op;
    program_.code.push_back(in);
  }

  void branch(int count) {
    ++nesting_;
    leave(Op::kIf);
    statements(count);
    if (below(2) != 0) {
      plain(Op::kElse);
      statements(count);
    }
    plain(Op::kEndIf);
    --nesting_;
  }

  /// A counted loop: counter += 1 where continued lanes come by, and a break when it reaches the trip count.
  void loop(int count) {
    const auto counter = static_cast<std::uint16_t>(kFirstCounter + nesting_++);
    ++loops_;
    Instruction reset;
    reset.op = Op::kMov;
    reset.dst = counter;
    reset.a = {Operand::kConstant, 0, kOne};
    program_.code.push_back(reset);
    plain(Op::kLoop);
    statements(count);
    plain(Op::kContinuing);
    Instruction step, test, leave_loop;
    step.op = Op::kIAdd;
    step.dst = counter;
    step.a = {Operand::kRegister, 0, counter};
    step.b = {Operand::kConstant, 0, kOne};
    test.op = Op::kILt;
    test.dst = kCondition;
    test.a = {Operand::kConstant, 0, kTrips};
    test.b = step.a;
    leave_loop.op = Op::kBreakIf;
    leave_loop.a = {Operand::kRegister, 0, kCondition};
    program_.code.insert(program_.code.end(), {step, test, leave_loop});
    plain(Op::kEndLoop);
    --loops_;
    --nesting_;
  }

  std::mt19937& random_;
  RandomProgramOptions options_;
  Program program_;
  int nesting_ = 0, loops_ = 0;
};

}  // namespace

Program random_program(std::mt19937& random, const RandomProgramOptions& options) {
  return Generator(random, options).generate();
}

}  // namespace quadrille::models::test
