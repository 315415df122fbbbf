/// Turns a checked program into the form that executes.
#include "models/shader/decode.h"

#include "models/base/error.h"
#include "models/shader/op_table.h"

#include <array>
#include <map>
#include <memory>

namespace quadrille::models {
namespace {

DecodedOperand decode_operand(const Operand& operand) {
  DecodedOperand decoded;
  decoded.offset = operand.kind == Operand::kRegister
                       ? static_cast<std::uint32_t>(operand.index * sizeof(RegisterRow))
                       : operand.index;
  if ((operand.modifiers & Operand::kAbsolute) != 0) decoded.keep = 0x7fffffffu;
  if ((operand.modifiers & Operand::kNegate) != 0) decoded.flip = 0x80000000u;
  return decoded;
}

KernelShape shape_of(const Instruction& in) {
  KernelShape shape;
  shape.sources = op_info(in.op).sources;
  shape.saturate = (in.flags & Instruction::kSaturate) != 0;
  const std::array<const Operand*, 3> operands{&in.a, &in.b, &in.c};
  for (unsigned i = 0; i < shape.sources; ++i) {
    if (operands[i]->kind == Operand::kConstant) shape.constants |= 1u << i;
    shape.modified = shape.modified || operands[i]->modifiers != 0;
  }
  return shape;
}

Kernel choose_kernel(const Program& program, const Instruction& in) {
  const KernelShape shape = shape_of(in);
  Kernel kernel = float_kernel(in.op, shape);
  if (kernel.all_lanes == nullptr) kernel = special_kernel(in.op, shape);
  if (kernel.all_lanes == nullptr) kernel = integer_kernel(in.op, shape);
  if (kernel.all_lanes == nullptr) kernel = interface_kernel(program, in, shape);
  if (kernel.all_lanes == nullptr) kernel = storage_kernel(in.op, shape);
  return kernel;
}

DecodedInstruction decode_instruction(const Program& program, const Instruction& in) {
  const Kernel kernel = choose_kernel(program, in);
  DecodedInstruction decoded;
  decoded.all_lanes = kernel.all_lanes;
  decoded.some_lanes = kernel.some_lanes;
  decoded.a = decode_operand(in.a);
  decoded.b = decode_operand(in.b);
  decoded.c = decode_operand(in.c);
  decoded.dst = static_cast<std::uint32_t>(in.dst * sizeof(RegisterRow));
  decoded.imm = in.imm;
  decoded.op = in.op;
  return decoded;
}

void count(IssueCounts& counts, IssueClass issue) {
  switch (issue) {
    case IssueClass::kAlu: ++counts.alu; break;
    case IssueClass::kSfu: ++counts.sfu; break;
    case IssueClass::kInterp: ++counts.interp; break;
    case IssueClass::kConst: ++counts.constant; break;
    case IssueClass::kTex:
    case IssueClass::kStorage: break;
    case IssueClass::kControl: ++counts.control; break;
    case IssueClass::kExport: ++counts.exported; break;
  }
}

/// Slots that are written outside of all control flow are always written.
std::vector<std::uint16_t> partial_outputs(const Program& program) {
  std::map<std::uint16_t, bool> always;
  if (program.stage == ShaderStage::kVertex)
    for (int slot = 0; slot < vertex_outputs(program); ++slot) always[static_cast<std::uint16_t>(slot)];
  int depth = 0;
  for (const Instruction& in : program.code) {
    if (in.op == Op::kIf || in.op == Op::kLoop) ++depth;
    if (in.op == Op::kEndIf || in.op == Op::kEndLoop) --depth;
    if (in.op == Op::kOutput) always[in.imm] |= depth == 0;
  }
  std::vector<std::uint16_t> partial;
  for (const auto& [slot, written] : always)
    if (!written) partial.push_back(slot);
  return partial;
}

}  // namespace

void prepare(const Program& program) {
  if (const auto fault = program_fault(program))
    throw user_error("shader '{}', instruction {}: {}", program.name, fault->instruction, fault->what);
  auto decoded = std::make_shared<DecodedProgram>();
  decoded->flow = analyse_flow(program);
  decoded->partial_outputs = partial_outputs(program);
  decoded->code.reserve(program.code.size());
  decoded->counts.resize(program.code.size() + 1);
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    decoded->code.push_back(decode_instruction(program, program.code[i]));
    QUADRILLE_CHECK(decoded->flow[i].control || decoded->code[i].all_lanes != nullptr, "no kernel for '{}'",
                    op_name(program.code[i].op));
    decoded->counts[i + 1] = decoded->counts[i];
    count(decoded->counts[i + 1], issue_class(program.code[i].op));
  }
  program.decoded.set(std::move(decoded));
}

}  // namespace quadrille::models
