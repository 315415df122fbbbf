/// Runs the slice of a vertex program that makes the position, on affine forms.
#include "pipeline/driver/position_bounds.h"

#include <bit>
#include <bitset>
#include <vector>

namespace quadrille::pipeline {
namespace {

using models::Instruction;
using models::Op;
using models::Operand;

/// What a register may hold in all lanes: one word, or the floats of a form.
struct Value {
  std::optional<std::uint32_t> word;
  Affine form;
};

Value word_value(std::uint32_t word) { return {word, affine_number(std::bit_cast<float>(word))}; }
Value form_value(const Affine& form) { return {{}, form}; }

Value either(const Value& a, const Value& b) {
  if (a.word && a.word == b.word) return a;
  return form_value(either(a.form, b.form));
}

bool is_position(const Instruction& in) { return in.op == Op::kOutput && in.imm < 4; }

template <class Visit>
void visit_sources(const Instruction& in, const Visit& visit) {
  const std::array<const Operand*, 3> operands{&in.a, &in.b, &in.c};
  for (int i = 0; i < models::source_count(in.op); ++i) visit(*operands[static_cast<std::size_t>(i)]);
}

/// The instructions that the position depends on. Within branches all that write a register that is read
/// later; none within loops, whose results are not known anyway.
std::vector<bool> position_slice(const std::vector<Instruction>& code) {
  std::vector<bool> slice(code.size());
  std::bitset<models::kMaxRegisters> needed;
  int loops = 0, branches = 0;
  for (std::size_t i = code.size(); i-- > 0;) {
    const Instruction& in = code[i];
    if (in.op == Op::kEndLoop) ++loops;
    if (in.op == Op::kLoop) --loops;
    if (loops > 0) continue;
    if (in.op == Op::kEndIf) ++branches;
    if (in.op == Op::kIf) --branches;
    bool wanted = is_position(in) || in.op == Op::kIf;
    for (int d = 0; d < models::destination_count(in.op); ++d) {
      const auto dst = in.dst + static_cast<std::size_t>(d);
      wanted = wanted || needed[dst];
      if (branches == 0) needed.reset(dst);
    }
    slice[i] = wanted;
    if (wanted)
      visit_sources(in, [&](const Operand& o) {
        if (o.kind == Operand::kRegister) needed.set(o.index);
      });
  }
  return slice;
}

class Interpreter {
 public:
  Interpreter(const models::Program& program, const ProgramInputs& inputs)
      : code_(program.code), inputs_(inputs), slice_(position_slice(code_)) {
    state_.registers.resize(static_cast<std::size_t>(program.num_regs));
  }

  std::array<Affine, 4> run() {
    run_to(0, code_.size());
    return state_.position;
  }

 private:
  struct State {
    std::vector<Value> registers;
    std::array<Affine, 4> position;
  };

  void run_to(std::size_t from, std::size_t end) {
    for (std::size_t i = from; i < end; ++i) {
      const Instruction& in = code_[i];
      if (in.op == Op::kIf) i = branch(i);
      else if (in.op == Op::kLoop) i = loop(i);
      else if (is_position(in)) state_.position[in.imm] = source(in.a).form;
      else if (slice_[i]) write(in);
    }
  }

  /// The end of the construct that begins at `at`, or its ELSE if that is asked for and there is one.
  [[nodiscard]] std::size_t end_of(std::size_t at, bool at_else) const {
    int depth = 0;
    for (std::size_t i = at;; ++i) {
      const Op op = code_[i].op;
      depth += op == Op::kIf || op == Op::kLoop ? 1 : 0;
      depth -= op == Op::kEndIf || op == Op::kEndLoop ? 1 : 0;
      if (depth == 0 || (at_else && depth == 1 && op == Op::kElse)) return i;
    }
  }

  /// Runs the sides of a branch, and returns where it ends.
  std::size_t branch(std::size_t at) {
    const std::size_t middle = end_of(at, true), end = end_of(at, false);
    const std::optional<std::uint32_t> condition = source(code_[at].a).word;
    if (condition) {
      if (*condition != 0) run_to(at + 1, middle);
      else run_to(middle + 1, end);
      return end;
    }
    const State before = state_;
    run_to(at + 1, middle);
    State first = std::move(state_);
    state_ = before;
    run_to(middle + 1, end);
    for (std::size_t r = 0; r < first.registers.size(); ++r)
      state_.registers[r] = either(first.registers[r], state_.registers[r]);
    for (std::size_t c = 0; c < 4; ++c) state_.position[c] = either(first.position[c], state_.position[c]);
    return end;
  }

  /// Forgets what a loop writes, and returns where it ends.
  std::size_t loop(std::size_t at) {
    const std::size_t end = end_of(at, false);
    for (std::size_t i = at; i < end; ++i) {
      if (is_position(code_[i])) state_.position[code_[i].imm] = {};
      forget(code_[i]);
    }
    return end;
  }
  void forget(const Instruction& in) {
    for (int d = 0; d < models::destination_count(in.op); ++d)
      state_.registers[in.dst + static_cast<std::size_t>(d)] = {};
  }

  [[nodiscard]] Value source(const Operand& operand) const {
    Value value;
    if (operand.kind == Operand::kRegister) value = state_.registers[operand.index];
    if (operand.kind == Operand::kConstant) value = word_value(inputs_.constants[operand.index]);
    if (operand.modifiers == 0) return value;
    value.word.reset();
    if ((operand.modifiers & Operand::kAbsolute) != 0) value.form = absolute(value.form);
    if ((operand.modifiers & Operand::kNegate) != 0) value.form = -value.form;
    return value;
  }

  void write(const Instruction& in) {
    if (models::destination_count(in.op) != 1) return forget(in);
    Value value = result(in);
    if ((in.flags & Instruction::kSaturate) != 0) value = form_value(saturated(value.form));
    state_.registers[in.dst] = value;
  }

  [[nodiscard]] Value result(const Instruction& in) const {
    const Value a = source(in.a), b = source(in.b), c = source(in.c);
    if (in.op == Op::kMov) return a;
    if (in.op == Op::kFAdd) return form_value(a.form + b.form);
    if (in.op == Op::kFMul) return form_value(a.form * b.form);
    // FMAD rounds twice and FMA once; what holds the first holds the second.
    if (in.op == Op::kFMad || in.op == Op::kFma) return form_value(a.form * b.form + c.form);
    if (in.op == Op::kFMin) return form_value(least(a.form, b.form));
    if (in.op == Op::kFMax) return form_value(greatest(a.form, b.form));
    if (in.op == Op::kInput) return input(in.imm);
    if (in.op == Op::kLoadConst) return loaded(in.imm, a.word, *b.word);
    if (in.op == Op::kSelect && a.word) return *a.word != 0 ? b : c;
    if (in.op == Op::kSelect) return either(b, c);
    return on_words(in.op, a.word, b.word);
  }

  /// What all lanes compute alike from one word or two.
  [[nodiscard]] static Value on_words(Op op, std::optional<std::uint32_t> a, std::optional<std::uint32_t> b) {
    if (!a) return {};
    if (op == Op::kI2F) return form_value(affine_number(static_cast<float>(static_cast<std::int32_t>(*a))));
    if (op == Op::kU2F) return form_value(affine_number(static_cast<float>(*a)));
    if (!b) return {};
    if (op == Op::kIAdd) return word_value(*a + *b);
    if (op == Op::kISub) return word_value(*a - *b);
    if (op == Op::kIMul) return word_value(*a * *b);
    if (op == Op::kIEq) return word_value(*a == *b ? ~0U : 0U);
    if (op == Op::kINe) return word_value(*a != *b ? ~0U : 0U);
    return {};
  }

  [[nodiscard]] Value input(std::uint16_t slot) const {
    if (slot == static_cast<std::uint16_t>(models::SystemValue::kInstanceIndex) && inputs_.instance)
      return word_value(*inputs_.instance);
    if (slot >= models::kFirstSystemValue) return {};
    const std::optional<InputBounds> bounds = inputs_.bounds(slot);
    if (!bounds) return {};
    return form_value(
        affine_input(slot, static_cast<double>(bounds->low), static_cast<double>(bounds->high)));
  }

  /// A constant at a known place, or any of those that an index can reach.
  [[nodiscard]] Value loaded(std::size_t first, std::optional<std::uint32_t> index,
                             std::uint32_t last) const {
    constexpr std::uint32_t kMost = 4096;  // words that are looked at
    if (index && *index <= last) return word_value(inputs_.constants[first + *index]);
    if (last >= kMost) return {};
    Value all = word_value(inputs_.constants[first]);
    for (std::uint32_t i = 1; i <= last; ++i) all = either(all, word_value(inputs_.constants[first + i]));
    return all;
  }

  const std::vector<Instruction>& code_;
  const ProgramInputs& inputs_;
  std::vector<bool> slice_;
  State state_;
};

}  // namespace

std::array<Affine, 4> position_bounds(const models::Program& program, const ProgramInputs& inputs) {
  return Interpreter(program, inputs).run();
}

}  // namespace quadrille::pipeline
