#include "pipeline/compiler/emit.h"

#include "models/base/error.h"
#include "models/shader/op_table.h"
#include "models/shader/warp.h"
#include "pipeline/compiler/atomic_outputs.h"
#include "pipeline/compiler/order.h"
#include "pipeline/compiler/passes.h"

#include <algorithm>
#include <array>
#include <set>

namespace quadrille::pipeline {
namespace {

using models::ConstantLayout;
using models::Instruction;
using models::Op;
using models::Operand;

constexpr std::uint32_t kMaxConstantWords = 65535;
constexpr std::uint32_t kSmallGap = 4;  ///< unused words that are kept so that two ranges become one

/// The words of the constant file that the code reads, and where they are put.
class ConstantFile {
 public:
  explicit ConstantFile(const ScalarShader& shader, const std::vector<ScalarInstruction>& code)
      : shader_(shader) {
    for (const ScalarInstruction& i : code) collect(i);
    if (!literals_.empty()) {
      ConstantLayout::Range range;
      range.words = static_cast<std::uint32_t>(literals_.size());
      range.literals = literals_;
      add(std::move(range));
    }
    std::vector<std::uint32_t> order;
    for (const auto& [block, words] : used_) order.push_back(block);
    const auto rank = [&](std::uint32_t b) {
      return std::tuple(shader_.blocks[b].source, shader_.blocks[b].set, shader_.blocks[b].binding, b);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
    for (const std::uint32_t block : order) place_block(block);
  }

  [[nodiscard]] std::uint16_t word_of(const Value& v) const {
    if (v.is_literal()) return static_cast<std::uint16_t>(literal_at_.at(v.bits));
    return static_cast<std::uint16_t>(uniform_at_.at(v.bits));
  }

  ConstantLayout layout;

 private:
  void collect(const ScalarInstruction& i) {
    const bool indexed = i.op == Op::kLoadConst;
    for (const Value& v : {i.a, i.b, i.c}) {
      if (v.is_literal() && literal_at_.emplace(v.bits, literals_.size()).second) literals_.push_back(v.bits);
      if (v.kind != Value::Kind::kUniform) continue;
      const std::uint32_t last = (v.bits & 0xffffu) + (indexed ? i.b.bits : 0);
      for (std::uint32_t word = v.bits & 0xffffu; word <= last; ++word) used_[v.bits >> 16].insert(word);
    }
  }

  void place_block(std::uint32_t block) {
    const std::set<std::uint32_t>& words = used_[block];
    for (auto word = words.begin(); word != words.end();) {
      const std::uint32_t first = *word;
      std::uint32_t last = first;
      for (; word != words.end() && *word <= last + kSmallGap; ++word) last = *word;
      ConstantLayout::Range range;
      const ConstantBlock& from = shader_.blocks[block];
      range.source = from.source;
      range.set = from.set;
      range.binding = from.binding;
      range.words = last - first + 1;
      if (from.source == ConstantLayout::Source::kLiteral)
        range.literals.assign(from.literals.begin() + first, from.literals.begin() + last + 1);
      else range.byte_offset = 4 * first;
      const std::uint32_t at = add(std::move(range));
      for (std::uint32_t k = first; k <= last; ++k) uniform_at_[block << 16 | k] = at + k - first;
    }
  }

  std::uint32_t add(ConstantLayout::Range range) {
    range.first_word = layout.words;
    layout.words += range.words;
    if (layout.words > kMaxConstantWords)
      throw user_error("{}: the shader reads more than {} constant words", shader_.name, kMaxConstantWords);
    layout.ranges.push_back(std::move(range));
    return layout.ranges.back().first_word;
  }

  const ScalarShader& shader_;
  std::vector<std::uint32_t> literals_;
  std::map<std::uint32_t, std::size_t> literal_at_;
  std::map<std::uint32_t, std::set<std::uint32_t>> used_;
  std::map<std::uint32_t, std::uint32_t> uniform_at_;
};

int control_depth(const std::vector<Instruction>& code) {
  int depth = 0, deepest = 0;
  for (const Instruction& i : code) {
    if (i.op == Op::kIf || i.op == Op::kLoop) deepest = std::max(deepest, ++depth);
    if (i.op == Op::kEndIf || i.op == Op::kEndLoop) --depth;
  }
  return deepest;
}

/// Packed slots for vertex inputs, textures and buffers, in order of raw slot.
template <class Slots>
std::map<std::uint16_t, std::uint16_t> pack(const Slots& used) {
  std::map<std::uint16_t, std::uint16_t> packed;
  for (const std::uint16_t slot : used) packed.emplace(slot, static_cast<std::uint16_t>(packed.size()));
  return packed;
}

class Encoder {
 public:
  Encoder(const ScalarShader& shader, const Linkage& linkage, const ShaderTarget& target)
      : shader_(shader),
        linkage_(linkage),
        chosen_(best_order(shader, target)),
        constants_(shader, chosen_.code) {
    std::set<std::uint16_t> inputs, textures, operations, buffers;
    for (const ScalarInstruction& i : chosen_.code) {
      if (i.op == Op::kInput && i.imm < models::kFirstSystemValue) inputs.insert(i.imm);
      if (names(i, models::Immediate::kTextureBinding)) textures.insert(i.imm);
      if (names(i, models::Immediate::kTextureOperation)) {
        operations.insert(i.imm);
        textures.insert(shader.texture_operations[i.imm].texture);
      }
      if (names(i, models::Immediate::kBufferBinding)) buffers.insert(i.imm);
    }
    inputs_ = pack(inputs);
    textures_ = pack(textures);
    operations_ = pack(operations);
    buffers_ = pack(buffers);
  }

  models::Program run() {
    check_limits();
    models::Program program;
    program.stage = shader_.stage;
    program.name = shader_.name;
    program.num_regs = chosen_.allocation.num_regs;
    program.constants = constants_.layout;
    program.varyings = linkage_.interpolation;
    if (shader_.stage == models::ShaderStage::kVertex) program.extras = linkage_.extras;
    program.early_fragment_tests = shader_.early_fragment_tests;
    program.by_sample = shader_.by_sample;
    for (const auto& [raw, slot] : inputs_)
      program.vertex_inputs.push_back(
          {static_cast<std::uint16_t>(raw / 4), static_cast<std::uint16_t>(raw % 4)});
    for (const auto& [raw, slot] : textures_) program.textures.push_back(shader_.textures[raw]);
    for (const auto& [raw, slot] : operations_) {
      program.texture_operations.push_back(shader_.texture_operations[raw]);
      std::uint16_t& texture = program.texture_operations.back().texture;
      texture = textures_.at(texture);
    }
    for (const auto& [raw, slot] : buffers_) program.buffers.push_back(shader_.buffers[raw]);
    program.outputs_follow_atomics = outputs_follow_atomics(shader_);
    program.second_source = shader_.second_source;
    program.color_kinds = shader_.color_kinds;
    for (const ScalarInstruction& i : chosen_.code) {
      const Instruction out = encode(i);
      const bool useless = out.op == Op::kMov && out.flags == 0 && out.a.kind == Operand::kRegister &&
                           out.a.modifiers == 0 && out.a.index == out.dst;
      if (useless) continue;
      program.uses_discard |= out.op == Op::kKillIf;
      // Where early tests are forced, the depth that it writes counts for nothing. [VK1.3 #fragops-early]
      program.writes_depth |= shader_.stage == models::ShaderStage::kFragment && out.op == Op::kOutput &&
                              out.imm == models::kDepthOutput && !shader_.early_fragment_tests;
      program.writes_sample_mask |= shader_.stage == models::ShaderStage::kFragment &&
                                    out.op == Op::kOutput && out.imm == models::kSampleMaskOutput;
      program.uses_derivatives |=
          (out.op >= Op::kDdxFine && out.op <= Op::kDdyCoarse) || models::takes_level_from_quad(out.op);
      program.code.push_back(out);
    }
    if (const int depth = control_depth(program.code); depth > models::kMaxControlDepth)
      throw user_error("{}: control flow is nested {} deep; at most {} is possible", shader_.name, depth,
                       models::kMaxControlDepth);
    return program;
  }

 private:
  [[nodiscard]] static bool names(const ScalarInstruction& i, models::Immediate what) {
    return models::op_info(i.op).immediate == what;
  }

  void check_limits() const {
    if (chosen_.allocation.num_regs > models::kMaxRegisters)
      throw user_error("{}: the shader needs {} registers; a lane has {}", shader_.name,
                       chosen_.allocation.num_regs, models::kMaxRegisters);
    if (inputs_.size() > static_cast<std::size_t>(models::kMaxVertexInputs))
      throw user_error("{}: the shader reads {} vertex input components; at most {} are possible",
                       shader_.name, inputs_.size(), models::kMaxVertexInputs);
  }

  [[nodiscard]] Operand operand(const Value& v) const {
    switch (v.kind) {
      case Value::Kind::kNone: return {};
      case Value::Kind::kRegister:
        return {Operand::kRegister, v.modifiers, chosen_.allocation.physical[v.bits]};
      case Value::Kind::kLiteral:
      case Value::Kind::kUniform: return {Operand::kConstant, v.modifiers, constants_.word_of(v)};
    }
    return {};
  }

  [[nodiscard]] std::uint16_t slot(const ScalarInstruction& i) const {
    if (i.op == Op::kInput && i.imm < models::kFirstSystemValue) return inputs_.at(i.imm);
    if (i.op == Op::kInterp) return linkage_.varyings.at(i.imm);
    if (names(i, models::Immediate::kTextureBinding)) return textures_.at(i.imm);
    if (names(i, models::Immediate::kTextureOperation)) return operations_.at(i.imm);
    if (names(i, models::Immediate::kBufferBinding)) return buffers_.at(i.imm);
    if (i.op == Op::kOutput && shader_.stage == models::ShaderStage::kVertex) return vertex_output(i.imm);
    if (i.op == Op::kLoadConst) return constants_.word_of(i.c);
    return i.imm;
  }

  [[nodiscard]] std::uint16_t vertex_output(std::uint16_t raw) const {
    if (raw < models::kFirstVaryingOutput) return raw;
    const auto varying = [&] {
      return linkage_.varyings.at(static_cast<std::uint16_t>(raw - models::kFirstVaryingOutput));
    };
    if (raw < kRawPointSize) return static_cast<std::uint16_t>(models::kFirstVaryingOutput + varying());
    const auto extra = static_cast<int>(models::kFirstVaryingOutput + linkage_.interpolation.size());
    const int clip = extra + (linkage_.extras.point_size ? 1 : 0),
              cull = clip + linkage_.extras.clip_distances;
    if (raw == kRawPointSize) return static_cast<std::uint16_t>(extra);
    if (raw < kRawCullDistance) return static_cast<std::uint16_t>(clip + (raw - kRawClipDistance));
    if (raw == kRawViewportIndex) return static_cast<std::uint16_t>(cull + linkage_.extras.cull_distances);
    return static_cast<std::uint16_t>(cull + (raw - kRawCullDistance));
  }

  [[nodiscard]] Instruction encode(const ScalarInstruction& i) const {
    Instruction out;
    out.op = i.op;
    out.flags = i.flags;
    out.imm = slot(i);
    if (models::destination_count(i.op) > 0) out.dst = chosen_.allocation.physical[i.dst];
    const int sources = models::source_count(i.op);
    if (sources > 0) out.a = operand(i.a);
    if (sources > 1) out.b = operand(i.b);
    if (sources > 2) out.c = operand(i.c);
    return out;
  }

  const ScalarShader& shader_;
  const Linkage& linkage_;
  OrderedCode chosen_;
  ConstantFile constants_;
  std::map<std::uint16_t, std::uint16_t> inputs_, textures_, operations_, buffers_;
};

}  // namespace

models::Program emit_program(const ScalarShader& shader, const Linkage& linkage, const ShaderTarget& target) {
  return Encoder(shader, linkage, target).run();
}

}  // namespace quadrille::pipeline
