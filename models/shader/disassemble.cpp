/// Prints a program as a listing that `assemble` reads back (docs/isa.md, "Listing").
#include "models/shader/decode.h"
#include "models/shader/listing_numbers.h"
#include "models/shader/listing_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace quadrille::models {
namespace {

std::string range_text(const ConstantLayout::Range& range) {
  switch (range.source) {
    case ConstantLayout::Source::kLiteral: {
      std::string line = fmt::format(".literal c{}", range.first_word);
      for (const std::uint32_t word : range.literals) line += fmt::format(" {}", literal_text(word));
      return line;
    }
    case ConstantLayout::Source::kPushConstant:
      return fmt::format(".push c{} offset={} words={}", range.first_word, range.byte_offset, range.words);
    case ConstantLayout::Source::kUniformBlock:
      return fmt::format(".uniform c{} set={} binding={} offset={} words={}", range.first_word, range.set,
                         range.binding, range.byte_offset, range.words);
  }
  return {};
}

/// Floats are not mentioned.
std::string kind_text(NumberKind kind) {
  if (kind == NumberKind::kFloat) return {};
  return fmt::format(" {}", kNumberKindNames[static_cast<std::size_t>(kind)]);
}

/// A combined plane is not mentioned.
std::string view_text(const TextureBinding& t) {
  std::string text;
  if (t.view != ViewKind::k2D) text += fmt::format(" {}", kViewKindNames[static_cast<std::size_t>(t.view)]);
  if (t.sampler_binding == kNoSampler) text += " no-sampler";
  else if (t.sampler_binding != kCombined)
    text += fmt::format(" sampler-set={} sampler-binding={}", t.sampler_set, t.sampler_binding);
  return text;
}

std::string operation_text(const TextureOperation& o) {
  return fmt::format(".texop texture={} {} {} compare={} offsets={} component={} x={} y={} z={}", o.texture,
                     kTextureAskNames[static_cast<std::size_t>(o.ask)],
                     kLevelFromNames[static_cast<std::size_t>(o.level)], o.compare ? 1 : 0, o.offsets ? 1 : 0,
                     o.component, o.offset[0], o.offset[1], o.offset[2]);
}

std::string header_text(const Program& p) {
  std::string title = p.name;
  std::replace_if(
      title.begin(), title.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  std::string text = fmt::format("; {}\n.stage {}\n.regs {}\n", title, stage_info(p.stage).name, p.num_regs);
  std::string flags;
  for (const NamedFlag& flag : kProgramFlags)
    if (p.*flag.member) flags += fmt::format(" {}", flag.name);
  if (!flags.empty()) text += fmt::format(".flags{}\n", flags);
  if (p.constants.words != 0) text += fmt::format(".constants {}\n", p.constants.words);
  for (const auto& range : p.constants.ranges) text += fmt::format("{}\n", range_text(range));
  for (const TextureBinding& t : p.textures)
    text +=
        fmt::format(".texture set={} binding={}{}{}\n", t.set, t.binding, kind_text(t.texels), view_text(t));
  for (const TextureOperation& o : p.texture_operations) text += fmt::format("{}\n", operation_text(o));
  for (std::size_t location = 0; location < p.color_kinds.size(); ++location)
    if (p.color_kinds[location] != NumberKind::kFloat)
      text += fmt::format(".color location={}{}\n", location, kind_text(p.color_kinds[location]));
  for (const BufferBinding& b : p.buffers)
    text += fmt::format(".buffer set={} binding={}\n", b.set, b.binding);
  for (const VertexInputUse& v : p.vertex_inputs)
    text += fmt::format(".input location={} component={}\n", v.location, v.component);
  for (const Interpolation mode : p.varyings)
    text += fmt::format(".varying {}\n", kInterpolationNames[static_cast<std::size_t>(mode)]);
  if (p.extras.count() > 0)
    text += fmt::format(".extras point_size={} clip={} cull={} viewport={}\n", p.extras.point_size ? 1 : 0,
                        p.extras.clip_distances, p.extras.cull_distances, p.extras.viewport_index ? 1 : 0);
  return text;
}

std::string operand_text(const Operand& operand) {
  std::string text = fmt::format("{}{}", operand.kind == Operand::kConstant ? 'c' : 'r', operand.index);
  if ((operand.modifiers & Operand::kAbsolute) != 0) text = fmt::format("|{}|", text);
  if ((operand.modifiers & Operand::kNegate) != 0) text = fmt::format("-{}", text);
  return text;
}

std::string slot_text(const Instruction& in, Immediate immediate) {
  const std::size_t system = static_cast<std::size_t>(in.imm) - kFirstSystemValue;
  if (immediate == Immediate::kInputSlot && system < kSystemValueNames.size())
    return std::string(kSystemValueNames[system]);
  return fmt::format("{}{}", slot_prefix(immediate), in.imm);
}

std::string instruction_text(const Program& p, const Instruction& in) {
  const OpInfo& info = op_info(in.op);
  std::string fields, values;
  const auto add = [&](const std::string& field) {
    fields += fmt::format("{}{}", fields.empty() ? "" : ", ", field);
  };
  if (info.destinations != 0) add(fmt::format("r{}", in.dst));
  if (info.immediate != Immediate::kUnused) add(slot_text(in, info.immediate));
  const Operand* const operands[] = {&in.a, &in.b, &in.c};
  for (int i = 0; i < info.sources; ++i) {
    add(operand_text(*operands[i]));
    if (operands[i]->kind != Operand::kConstant) continue;
    if (const std::uint32_t* value = literal_value(p.constants, operands[i]->index))
      values +=
          fmt::format("{}c{} = {}", values.empty() ? "  ; " : ", ", operands[i]->index, literal_text(*value));
  }
  std::string mnemonic =
      fmt::format("{}{}", info.name, (in.flags & Instruction::kSaturate) != 0 ? ".sat" : "");
  if (fields.empty()) return mnemonic;
  return fmt::format("{:<11} {}{}", mnemonic, fields, values);
}

bool opens(Op op) { return op == Op::kIf || op == Op::kLoop || op == Op::kElse || op == Op::kContinuing; }
bool closes(Op op) {
  return op == Op::kEndIf || op == Op::kEndLoop || op == Op::kElse || op == Op::kContinuing;
}

}  // namespace

std::string disassemble(const Program& program) {
  std::string text = header_text(program);
  std::size_t depth = 0;
  for (const Instruction& in : program.code) {
    if (closes(in.op) && depth > 0) --depth;
    text += fmt::format("{:{}}{}\n", "", 2 * depth + 2, instruction_text(program, in));
    if (opens(in.op)) ++depth;
  }
  return text;
}

}  // namespace quadrille::models
