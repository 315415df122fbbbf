#include "pipeline/compiler/passes.h"

#include "models/shader/op_table.h"
#include "pipeline/compiler/builder.h"

#include <algorithm>
#include <utility>

namespace quadrille::pipeline {
namespace {

using models::Instruction;
using models::Op;
using models::Operand;

void remove_dead(ScalarShader& shader) {
  const std::size_t registers = shader.variable.size();
  std::vector<std::vector<std::uint32_t>> definitions(registers);
  std::vector<std::uint32_t> work;
  std::vector<bool> live(shader.code.size(), false);
  for (std::uint32_t at = 0; at < shader.code.size(); ++at) {
    const ScalarInstruction& i = shader.code[at];
    for (int k = 0; k < models::destination_count(i.op); ++k)
      definitions[i.dst + static_cast<std::uint32_t>(k)].push_back(at);
    if (!has_effect(i.op)) continue;
    live[at] = true;
    work.push_back(at);
  }
  std::vector<bool> needed(registers, false);
  while (!work.empty()) {
    const ScalarInstruction& i = shader.code[work.back()];
    work.pop_back();
    for (const Value& v : {i.a, i.b, i.c}) {
      if (!v.is_register() || needed[v.bits]) continue;
      needed[v.bits] = true;
      for (const std::uint32_t at : definitions[v.bits])
        if (!live[at]) {
          live[at] = true;
          work.push_back(at);
        }
    }
  }
  std::size_t kept = 0;
  for (std::size_t at = 0; at < shader.code.size(); ++at)
    if (live[at]) shader.code[kept++] = shader.code[at];
  shader.code.resize(kept);
}

bool is_always(const ScalarInstruction& i, Op op) { return i.op == op && i.a.is_literal() && i.a.bits != 0; }

/// Appends ENDIF, or what an IF with an empty or one-instruction body is worth.
void close_if(std::vector<ScalarInstruction>& out, const ScalarInstruction& end) {
  if (!out.empty() && out.back().op == Op::kElse) out.pop_back();
  if (!out.empty() && out.back().op == Op::kIf) {
    out.pop_back();
    return;
  }
  const std::size_t n = out.size();
  if (n >= 2 && out[n - 2].op == Op::kIf)
    for (const Op exit : {Op::kKillIf, Op::kBreakIf, Op::kContinueIf})
      if (is_always(out[n - 1], exit)) {
        const Value condition = out[n - 2].a;
        out.pop_back();
        out.back().op = exit;
        out.back().a = condition;
        return;
      }
  out.push_back(end);
}

/// Drops a CONTINUEIF of all lanes that only leads to where the lanes go anyway.
bool drop_final_continue(std::vector<ScalarInstruction>& out) {
  std::size_t at = out.size();
  while (at > 0 && out[at - 1].op == Op::kEndIf) --at;
  if (at == 0 || !is_always(out[at - 1], Op::kContinueIf)) return false;
  out.erase(out.begin() + static_cast<std::ptrdiff_t>(at - 1));
  return true;
}

bool simplify_control(ScalarShader& shader) {
  std::vector<ScalarInstruction> out;
  const std::size_t before = shader.code.size();
  for (const ScalarInstruction& i : shader.code) {
    const bool never =
        (i.op == Op::kKillIf || i.op == Op::kBreakIf || i.op == Op::kContinueIf) && i.a.is_literal(0);
    if (i.op == Op::kNop || never) continue;
    if (i.op == Op::kEndIf) {
      close_if(out, i);
      continue;
    }
    if (i.op == Op::kContinuing || i.op == Op::kEndLoop) drop_final_continue(out);
    out.push_back(i);
  }
  shader.code = std::move(out);
  return shader.code.size() != before;
}

/// CONTINUING without a CONTINUEIF is an ordinary place in the body.
void drop_unused_continuing(ScalarShader& shader) {
  struct Loop {
    std::size_t continuing = 0;
    bool continued = false;
  };
  std::vector<Loop> loops;
  for (std::size_t at = 0; at < shader.code.size(); ++at) {
    const Op op = shader.code[at].op;
    if (op == Op::kLoop) loops.push_back({});
    if (op == Op::kContinueIf) loops.back().continued = true;
    if (op == Op::kContinuing) loops.back().continuing = at;
    if (op != Op::kEndLoop) continue;
    if (loops.back().continuing != 0 && !loops.back().continued)
      shader.code[loops.back().continuing].op = Op::kNop;
    loops.pop_back();
  }
  std::erase_if(shader.code, [](const ScalarInstruction& i) { return i.op == Op::kNop; });
}

/// Where each register is defined, how often it is read, and which straight-line stretch an instruction is
/// in.
struct Uses {
  std::vector<std::size_t> definition;
  std::vector<std::uint32_t> reads, stretch;
  explicit Uses(const ScalarShader& shader)
      : definition(shader.variable.size(), shader.code.size()),
        reads(shader.variable.size(), 0),
        stretch(shader.code.size(), 0) {
    std::uint32_t current = 0;
    for (std::size_t at = 0; at < shader.code.size(); ++at) {
      const ScalarInstruction& i = shader.code[at];
      if (is_control(i.op)) ++current;
      stretch[at] = current;
      for (const Value& v : {i.a, i.b, i.c})
        if (v.is_register()) ++reads[v.bits];
      if (models::destination_count(i.op) == 1) definition[i.dst] = at;
    }
  }
  /// Place of the instruction that makes `v` for nobody but the reader at `at`, in the same stretch; the end
  /// of the code if there is none.
  [[nodiscard]] std::size_t private_maker(const ScalarShader& shader, const Value& v, std::size_t at) const {
    if (!v.is_register() || shader.variable[v.bits] || reads[v.bits] != 1) return shader.code.size();
    const std::size_t made = definition[v.bits];
    return made < at && stretch[made] == stretch[at] ? made : shader.code.size();
  }
};

void fuse_multiply_add(ScalarShader& shader) {
  const Uses uses(shader);
  for (std::size_t at = 0; at < shader.code.size(); ++at) {
    ScalarInstruction& sum = shader.code[at];
    if (sum.op != Op::kFAdd) continue;
    const auto product_of = [&](const Value& v) {
      const std::size_t made =
          (v.modifiers & Operand::kAbsolute) != 0 ? shader.code.size() : uses.private_maker(shader, v, at);
      return made < shader.code.size() && shader.code[made].op == Op::kFMul && shader.code[made].flags == 0
                 ? made
                 : shader.code.size();
    };
    std::size_t first = product_of(sum.a), second = product_of(sum.b);
    if (first == shader.code.size() && second == shader.code.size()) continue;
    const bool use_first = second == shader.code.size() || (first != shader.code.size() && first > second);
    const Value used = use_first ? sum.a : sum.b, other = use_first ? sum.b : sum.a;
    ScalarInstruction& product = shader.code[use_first ? first : second];
    sum.op = Op::kFMad;
    sum.a = product.a;
    sum.b = product.b;
    sum.c = other;
    if ((used.modifiers & Operand::kNegate) != 0) sum.a.modifiers ^= Operand::kNegate;
    if (sum.a.is_literal() && sum.a.modifiers != 0)
      sum.a = {Value::Kind::kLiteral, 0, sum.a.bits ^ 0x80000000u};
    product = {};
  }
  std::erase_if(shader.code, [](const ScalarInstruction& i) { return i.op == Op::kNop; });
}

void fold_saturate(ScalarShader& shader) {
  const Uses uses(shader);
  for (std::size_t at = 0; at < shader.code.size(); ++at) {
    ScalarInstruction& clamp = shader.code[at];
    if (clamp.op != Op::kMov || clamp.flags != Instruction::kSaturate || clamp.a.modifiers != 0) continue;
    const std::size_t made = uses.private_maker(shader, clamp.a, at);
    if (made == shader.code.size() || !models::op_info(shader.code[made].op).saturable ||
        shader.code[made].op == Op::kSelect)
      continue;
    shader.code[made].flags |= Instruction::kSaturate;
    shader.code[made].dst = clamp.dst;
    clamp = {};
  }
  std::erase_if(shader.code, [](const ScalarInstruction& i) { return i.op == Op::kNop; });
}

}  // namespace

bool is_control(Op op) { return op >= Op::kIf && op <= Op::kEndLoop; }
bool has_effect(Op op) {
  return is_control(op) || op == Op::kKillIf || op == Op::kOutput || op == Op::kEnd ||
         models::writes_buffer(op);
}
bool is_texture(Op op) { return models::is_texture_request(op); }
bool is_request(Op op) { return is_texture(op) || op == Op::kLoadBuffer; }

void clean_up(ScalarShader& shader) {
  do { remove_dead(shader); } while (simplify_control(shader));
  drop_unused_continuing(shader);
  fuse_multiply_add(shader);
  fold_saturate(shader);
  remove_dead(shader);
}

}  // namespace quadrille::pipeline
