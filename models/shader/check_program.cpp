/// Rules that a program must keep so that its execution needs no checks: registers, slots and constants
/// exist, control flow nests and ends.
#include "models/base/error.h"
#include "models/shader/decode.h"
#include "models/shader/op_table.h"

#include <algorithm>
#include <array>
#include <vector>

namespace quadrille::models {
namespace {

/// Walks the instructions of one program and throws a `ProgramFault` at the first broken rule.
class Checker {
 public:
  explicit Checker(const Program& program) : program_(program) {}

  void check() {
    check_header();
    for (index_ = 0; index_ < program_.code.size(); ++index_) {
      const Instruction& in = program_.code[index_];
      require(in.op < Op::kCount, "operation number {} does not exist", static_cast<int>(in.op));
      check_operands(in);
      check_immediate(in);
      check_stage(in);
      check_structure(in);
    }
    index_ = program_.code.size() - 1;
    require(program_.code.back().op == Op::kEnd, "the last instruction is '{}', it must be 'end'",
            op_name(program_.code.back().op));
  }

 private:
  template <class... Args>
  void require(bool holds, fmt::format_string<Args...> text, Args&&... args) const {
    if (holds) return;
    throw ProgramFault{index_, fmt::format(text, std::forward<Args>(args)...)};
  }

  void check_header() const {
    require(!program_.code.empty(), "there are no instructions; at least 'end' is needed");
    require(program_.num_regs >= 0 && program_.num_regs <= kMaxRegisters, "{} registers; legal: 0 to {}",
            program_.num_regs, kMaxRegisters);
    require(program_.varyings.size() <= kMaxVaryings, "{} varying components; legal: at most {}",
            program_.varyings.size(), kMaxVaryings);
    require(program_.vertex_inputs.size() <= kMaxVertexInputs,
            "{} vertex input components; legal: at most {}", program_.vertex_inputs.size(), kMaxVertexInputs);
    require(program_.extras.clip_distances + program_.extras.cull_distances <= kMaxUserDistances,
            "{} clip and {} cull distances; legal: at most {} together", program_.extras.clip_distances,
            program_.extras.cull_distances, kMaxUserDistances);
  }

  void check_operands(const Instruction& in) const {
    const OpInfo& info = op_info(in.op);
    const std::array<const Operand*, 3> operands{&in.a, &in.b, &in.c};
    for (unsigned i = 0; i < info.sources; ++i) {
      const Operand& operand = *operands[i];
      const char name = static_cast<char>('a' + i);
      require(operand.kind == Operand::kRegister || operand.kind == Operand::kConstant,
              "'{}' lacks its operand {}", info.name, name);
      if (operand.kind == Operand::kRegister)
        require(operand.index + operand_width(in.op) <= program_.num_regs,
                "operand {} is r{}; the program has {} registers", name, operand.index, program_.num_regs);
      else
        require(operand.index < program_.constants.words, "operand {} is c{}; the constant file has {} words",
                name, operand.index, program_.constants.words);
      require(operand.modifiers == 0 || ((info.modifiable >> i) & 1u) != 0,
              "operand {} of '{}' takes no modifier", name, info.name);
    }
    require((in.flags & Instruction::kSaturate) == 0 || info.saturable, "'{}' cannot saturate", info.name);
    require(info.destinations == 0 || in.dst + info.destinations <= program_.num_regs,
            "'{}' writes r{} to r{}; the program has {} registers", info.name, in.dst,
            in.dst + info.destinations - 1, program_.num_regs);
  }

  void check_immediate(const Instruction& in) const {
    switch (op_info(in.op).immediate) {
      case Immediate::kUnused: break;
      case Immediate::kInputSlot: check_input(in.imm); break;
      case Immediate::kVaryingSlot:
        require(in.imm < program_.varyings.size(), "varying {} does not exist; the program has {}", in.imm,
                program_.varyings.size());
        break;
      case Immediate::kOutputSlot: {
        const std::size_t slots = program_.stage == ShaderStage::kVertex
                                      ? static_cast<std::size_t>(vertex_outputs(program_))
                                      : std::size_t{kFragmentOutputs};
        require(in.imm < slots, "output slot {} does not exist; the stage has {}", in.imm, slots);
        break;
      }
      case Immediate::kConstantWord: check_indexed_constant(in); break;
      case Immediate::kTextureBinding:
        require(in.imm < program_.textures.size(), "texture {} does not exist; the program has {}", in.imm,
                program_.textures.size());
        require(!is_texture_request(in.op) || !is_multisampled(program_.textures[in.imm].view),
                "'{}' of texture {}, of which single samples are fetched", op_name(in.op), in.imm);
        break;
      case Immediate::kTextureOperation: check_texture_operation(in); break;
      case Immediate::kBufferBinding:
        require(in.imm < program_.buffers.size(), "buffer {} does not exist; the program has {}", in.imm,
                program_.buffers.size());
        break;
    }
  }

  void check_texture_operation(const Instruction& in) const {
    const std::size_t count = program_.texture_operations.size();
    require(in.imm < count, "texture operation {} does not exist; the program has {}", in.imm, count);
    const TextureOperation& operation = program_.texture_operations[in.imm];
    require(operation.texture < program_.textures.size(), "texture {} does not exist; the program has {}",
            operation.texture, program_.textures.size());
    const ViewKind view = program_.textures[operation.texture].view;
    const bool fetches = operation.ask == TextureAsk::kFetch && operation.level == LevelFrom::kLevel;
    require(fetches || !is_multisampled(view),
            "an operation on texture {}, of which single samples are fetched", operation.texture);
    const int words = word_count(operation, view);
    require(words <= kMaxTextureWords, "a texture operation of {} words; legal: at most {}", words,
            kMaxTextureWords);
    const bool from_quad = operation.level == LevelFrom::kQuad || operation.level == LevelFrom::kBias;
    require(from_quad == (in.op == Op::kTexOpQuad), "'{}' with a level of detail {}", op_name(in.op),
            from_quad ? "from the quad" : "that is given");
  }

  void check_input(std::uint16_t slot) const {
    const StageInfo& stage = stage_info(program_.stage);
    if (slot < kFirstSystemValue)
      require(stage.fetches && slot < program_.vertex_inputs.size(),
              "vertex input {} does not exist; the program has {}", slot,
              stage.fetches ? program_.vertex_inputs.size() : 0u);
    else
      require(slot >= static_cast<std::uint16_t>(stage.first_system_value) &&
                  slot <= static_cast<std::uint16_t>(stage.last_system_value),
              "system value {} does not exist in this stage", slot);
  }

  void check_indexed_constant(const Instruction& in) const {
    const std::uint32_t* last =
        in.b.kind == Operand::kConstant ? literal_value(program_.constants, in.b.index) : nullptr;
    require(last != nullptr, "operand b of 'loadconst' must be a literal, the largest index");
    require(*last < program_.constants.words && in.imm + *last < program_.constants.words,
            "'loadconst' reaches c[{} + {}]; the constant file has {} words", in.imm, *last,
            program_.constants.words);
  }

  void check_stage(const Instruction& in) const {
    const bool implicit = takes_level_from_quad(in.op);
    const bool derivative = in.op >= Op::kDdxFine && in.op <= Op::kDdyCoarse;
    const bool needs_quads = implicit || derivative || in.op == Op::kInterp || in.op == Op::kKillIf;
    require(!needs_quads || stage_info(program_.stage).quads, "'{}' exists only in fragment shaders",
            op_name(in.op));
  }

  struct Construct {
    Op op = Op::kIf;           ///< kIf or kLoop
    bool second_part = false;  ///< past its kElse or kContinuing
  };

  [[nodiscard]] bool inside(Op op) const { return !open_.empty() && open_.back().op == op; }

  void check_structure(const Instruction& in) {
    const bool last = index_ + 1 == program_.code.size();
    if (in.op == Op::kIf || in.op == Op::kLoop) {
      require(open_.size() < static_cast<std::size_t>(kMaxControlDepth), "control flow nests deeper than {}",
              kMaxControlDepth);
      open_.push_back({in.op, false});
    } else if (in.op == Op::kElse || in.op == Op::kContinuing) {
      require(inside(in.op == Op::kElse ? Op::kIf : Op::kLoop) && !open_.back().second_part,
              "'{}' has no {} to belong to", op_name(in.op), in.op == Op::kElse ? "'if'" : "'loop'");
      open_.back().second_part = true;
    } else if (in.op == Op::kEndIf || in.op == Op::kEndLoop) {
      require(inside(in.op == Op::kEndIf ? Op::kIf : Op::kLoop), "'{}' does not end the innermost construct",
              op_name(in.op));
      open_.pop_back();
    } else if (in.op == Op::kBreakIf || in.op == Op::kContinueIf) {
      const bool in_loop =
          std::any_of(open_.begin(), open_.end(), [](const Construct& c) { return c.op == Op::kLoop; });
      require(in_loop, "'{}' is outside a loop", op_name(in.op));
    } else if (in.op == Op::kEnd) {
      require(last, "'end' before the last instruction");
      require(open_.empty(), "'end' inside an open '{}'",
              open_.empty() ? std::string_view{} : op_name(open_.back().op));
    }
  }

  const Program& program_;
  std::size_t index_ = 0;
  std::vector<Construct> open_;
};

}  // namespace

const std::uint32_t* literal_value(const ConstantLayout& layout, std::uint32_t word) {
  for (const ConstantLayout::Range& range : layout.ranges) {
    if (range.source != ConstantLayout::Source::kLiteral || word < range.first_word) continue;
    if (word - range.first_word < range.literals.size()) return &range.literals[word - range.first_word];
  }
  return nullptr;
}

std::optional<ProgramFault> program_fault(const Program& program) {
  try {
    Checker(program).check();
    return std::nullopt;
  } catch (const ProgramFault& fault) { return fault; }
}

}  // namespace quadrille::models
