/// Decoding a module: what all parts share, constants, and the order of it all.
#include "models/reference/decode.h"

#include <spirv/unified1/spirv.hpp>

#include "models/base/error.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

constexpr std::size_t kMaxProgramCells = std::size_t{1} << 21;

bool is_null_or_undefined(std::uint32_t op) { return op == spv::OpConstantNull || op == spv::OpUndef; }

}  // namespace

Decoder::Decoder(const traces::Shader& shader) : module_(read_spirv(shader)), stage_(shader.stage) {
  program_.name = shader.name;
  program_.early_fragment_tests = module_.early_fragment_tests;
  globals_.resize(module_.types.size());
  zero_slot_ = allocate(1);
}

ShaderProgram Decoder::decode() {
  for (const SpirvInstruction& in : module_.globals) {
    if (in.op == spv::OpVariable) {
      variable(in);
    } else {
      constant(in);
    }
  }
  Frame frame;
  frame.function = &module_.functions.at(module_.entry);
  frame.return_label = new_label();
  begin_block(new_label());
  for (const SpirvInstruction& in : initialised_) {
    const Value& target = globals_[in.result];
    if (in.words.size() > 1) {
      copy(target.slot, globals_[in.words[1]].slot, cells(target.type));
    } else {
      zero(target.slot, cells(target.type));
    }
  }
  inline_function(frame);
  begin_block(frame.return_label);
  end_block(BlockEnd::kStop, kNoSlot);
  resolve_labels();
  return std::move(program_);
}

void Decoder::constant(const SpirvInstruction& in) {
  check_type(in.type);
  if (in.op == spv::OpSpecConstantOp) return specialised(in);
  Value& v = globals_[in.result];
  v = new_value(in.type);
  set_constant(in, v);
}

/// The operation is decoded as if it stood in a function, and run at once.
void Decoder::specialised(const SpirvInstruction& in) {
  SpirvInstruction step = in;
  step.op = in.words[0];
  step.words.erase(step.words.begin());
  Frame frame;
  const std::size_t first = program_.code.size();
  instruction(frame, step);
  Lanes lanes;
  lanes.cells = program_.initial;
  for (std::size_t k = first; k < program_.code.size(); ++k) program_.code[k].run(program_.code[k], lanes);
  program_.initial = std::move(lanes.cells);
  program_.code.resize(first);
  const Value& result = globals_[in.result] = frame.values.at(in.result);
  if (module_.type(in.type).kind == TypeKind::kInt)
    constant_words_[in.result] = program_.initial[result.slot].u(0);
}

void Decoder::set_constant(const SpirvInstruction& in, Value& v) {
  const SpirvType& type = module_.type(in.type);
  if (is_null_or_undefined(in.op)) return;  // cells start at zero
  if (in.op == spv::OpConstantComposite || in.op == spv::OpSpecConstantComposite) {
    Slot at = v.slot;
    for (const Id part : in.words) {
      for (std::uint32_t i = 0; i < cells(globals_[part].type); ++i)
        program_.initial[at++] = program_.initial[globals_[part].slot + i];
    }
    return;
  }
  const bool is_bool = in.op == spv::OpConstantTrue || in.op == spv::OpSpecConstantTrue;
  const bool is_word = in.op == spv::OpConstant || in.op == spv::OpSpecConstant;
  if (!is_bool && !is_word && in.op != spv::OpConstantFalse && in.op != spv::OpSpecConstantFalse)
    unsupported_op(in.op);
  for (int lane = 0; lane < kLanes; ++lane) {
    Cell& cell = program_.initial[v.slot];
    if (type.kind == TypeKind::kFloat) {
      cell.set_f(lane, static_cast<double>(std::bit_cast<float>(in.words[0])));
    } else {
      cell.set_u(lane, is_word ? in.words[0] : (is_bool ? 1u : 0u));
    }
  }
  if (type.kind == TypeKind::kInt) constant_words_[in.result] = in.words[0];
}

Slot Decoder::allocate(std::uint32_t n) {
  const std::size_t first = program_.initial.size();
  if (first + n > kMaxProgramCells)
    throw user_error("shader '{}': needs more than {} scalars, the reference's limit", module_.name,
                     kMaxProgramCells);
  program_.initial.resize(first + n);
  return static_cast<Slot>(first);
}

Value Decoder::new_value(Id type) {
  return {Value::Kind::kCells, type, allocate(cells(type)), kNoSlot, false};
}

Value& Decoder::define(Frame& frame, const SpirvInstruction& in) {
  check_type(in.type);
  return frame.values[in.result] = new_value(in.type);
}

const Value& Decoder::value(const Frame& frame, Id id) const {
  const auto found = frame.values.find(id);
  const Value& v = found != frame.values.end() ? found->second : globals_[id];
  if (v.kind == Value::Kind::kNone) unsupported("an operand the reference does not evaluate");
  return v;
}

std::uint32_t Decoder::constant_word(Id id, std::string_view what) const {
  const auto found = constant_words_.find(id);
  if (found == constant_words_.end()) unsupported(what);
  return found->second;
}

Operation& Decoder::emit(Handler handler, std::uint32_t n, Slot dst, std::initializer_list<Slot> sources) {
  Operation& o = program_.code.emplace_back();
  o.run = handler, o.n = n, o.dst = dst;
  std::size_t i = 0;
  for (const Slot source : sources) o.src.at(i++) = source;
  return o;
}

void Decoder::copy(Slot dst, Slot src, std::uint32_t n) {
  if (n != 0 && dst != src) emit(copy_cells, n, dst, {src});
}

void Decoder::zero(Slot dst, std::uint32_t n) {
  if (n != 0) emit(copy_cells, n, dst, {zero_slot_}).step[0] = 0;
}

void Decoder::check_type(Id type) const {
  const SpirvType& t = module_.type(type);
  if (t.kind == TypeKind::kUnsupported) unsupported(t.problem);
}

void Decoder::unsupported(std::string_view what) const {
  throw user_error("shader '{}': the reference renderer does not support {}", module_.name, what);
}

void Decoder::unsupported_op(std::uint32_t op) const {
  throw user_error("shader '{}': the reference renderer does not support SPIR-V instruction {}", module_.name,
                   op);
}

ShaderProgram decode_shader(const traces::Shader& shader) { return Decoder(shader).decode(); }

}  // namespace quadrille::models::reference
