#include "pipeline/compiler/spirv_module.h"

#include "models/base/error.h"
#include "pipeline/compiler/spirv_names.h"
#include "pipeline/compiler/spirv_spec_constants.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace quadrille::pipeline::spirv {
namespace {

std::string literal_string(std::span<const std::uint32_t> words) {
  const char* text = reinterpret_cast<const char*>(words.data());
  return std::string(text, strnlen(text, words.size() * 4));
}

std::uint32_t saturating_product(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(a * b, 1u << 24));
}

}  // namespace

std::vector<Id> successors(const Block& block) {
  const std::span<const std::uint32_t> operands = block.terminator.operands;
  switch (static_cast<std::uint32_t>(block.terminator.op)) {
    case spv::OpBranch: return {operands[0]};
    case spv::OpBranchConditional: return {operands[1], operands[2]};
    case spv::OpSwitch: break;
    default: return {};
  }
  std::vector<Id> result;  // the default, then pairs of literal and label
  for (std::size_t k = 1; k < operands.size(); k += 2) result.push_back(operands[k]);
  return result;
}

Module::Module(std::vector<std::uint32_t> words, models::ShaderStage stage, std::string_view shader_name)
    : shader(shader_name), words_(std::move(words)), stage_(stage) {
  bound = words_.size() > 3 ? words_[3] : 0;
  for (std::size_t at = 5; at < words_.size();) {
    const std::size_t count = words_[at] >> 16;
    if (count == 0 || at + count > words_.size())
      throw user_error("{}: the module ends inside an instruction", shader);
    Instruction instruction;
    instruction.op = static_cast<spv::Op>(words_[at] & 0xffffu);
    bool has_result = false, has_type = false;
    spv::HasResultAndType(instruction.op, &has_result, &has_type);
    const std::size_t fixed = 1u + (has_result ? 1u : 0u) + (has_type ? 1u : 0u);
    if (count < fixed) throw user_error("{}: instruction at word {} is too short", shader, at);
    if (has_type) instruction.type = words_[at + 1];
    if (has_result) instruction.result = words_[at + fixed - 1];
    instruction.operands = {words_.data() + at + fixed, count - fixed};
    add(instruction);
    at += count;
  }
  if (!wide_types_.empty()) throw user_error("{}: {}", shader, wide_types_.begin()->second);
  if (entry == 0)
    throw user_error(
        "{}: no entry point \"main\" of the {} stage{}", shader,
        stage_ == models::ShaderStage::kVertex ? "vertex" : "fragment",
        other_entry_points_.empty() ? "" : fmt::format("; it has {}", fmt::join(other_entry_points_, ", ")));
}

const Type& Module::type(Id id) const {
  const auto found = types_.find(id);
  if (found == types_.end()) throw user_error("{}: type %{} is not known", shader, id);
  return found->second;
}

const Decorations& Module::decorations(Id id) const {
  static const Decorations kNothing;
  const auto found = decorations_.find(id);
  return found == decorations_.end() ? kNothing : found->second;
}

const Decorations& Module::member_decorations(Id type, std::uint32_t member) const {
  static const Decorations kNothing;
  const auto found = member_decorations_.find({type, member});
  return found == member_decorations_.end() ? kNothing : found->second;
}

const Block& Module::block(Id label) const {
  const auto found = blocks.find(label);
  if (found == blocks.end()) throw user_error("{}: block %{} is not in the entry point", shader, label);
  return found->second;
}

const std::vector<std::uint32_t>* Module::constant(Id id) const {
  const auto found = constants_.find(id);
  return found == constants_.end() ? nullptr : &found->second;
}

Id Module::constant_type(Id id) const {
  const auto found = constant_types_.find(id);
  if (found == constant_types_.end())
    throw user_error("{}: {} has no type that the compiler knows", shader, name(id));
  return found->second;
}

std::string Module::name(Id id) const {
  const auto found = names_.find(id);
  return found == names_.end() || found->second.empty() ? fmt::format("%{}", id)
                                                        : fmt::format("'{}'", found->second);
}

std::string Module::at(const Instruction& instruction, std::string_view text) const {
  return instruction.line == 0 ? fmt::format("{}: {}", shader, text)
                               : fmt::format("{}:{}: {}", shader, instruction.line, text);
}

std::string Module::at_use(Id id, std::string_view text) const {
  std::uint32_t line = 0;
  for (const auto& entry_and_block : blocks) {
    for (const Instruction& i : entry_and_block.second.body) {
      const bool uses = (i.op == spv::OpLoad || i.op == spv::OpStore || i.op == spv::OpAccessChain ||
                         i.op == spv::OpInBoundsAccessChain || i.op == spv::OpImageTexelPointer) &&
                        i.operands[0] == id;
      if (uses && i.line != 0 && (line == 0 || i.line < line)) line = i.line;
    }
  }
  return line == 0 ? fmt::format("{}: {}", shader, text) : fmt::format("{}:{}: {}", shader, line, text);
}

void Module::add(const Instruction& given) {
  Instruction instruction = given;
  instruction.line = line_;
  switch (static_cast<std::uint32_t>(instruction.op)) {
    case spv::OpLine: line_ = instruction.operands[1]; break;
    case spv::OpNoLine: line_ = 0; break;
    case spv::OpName:
      names_[instruction.operands[0]] = literal_string(instruction.operands.subspan(1));
      break;
    case spv::OpCapability: add_capability(instruction.operands[0]); break;
    case spv::OpExtInstImport:
      if (literal_string(instruction.operands) == "GLSL.std.450")
        glsl_imports[instruction.result] = instruction.result;
      break;
    case spv::OpEntryPoint: add_entry_point(instruction); break;
    case spv::OpExecutionMode:
      if (instruction.operands[0] == entry_function_ &&
          instruction.operands[1] == spv::ExecutionModeEarlyFragmentTests)
        early_fragment_tests = true;
      break;
    case spv::OpDecorate:
      add_decoration(decorations_[instruction.operands[0]],
                     static_cast<spv::Decoration>(instruction.operands[1]), instruction.operands.subspan(2));
      break;
    case spv::OpMemberDecorate:
      add_decoration(member_decorations_[{instruction.operands[0], instruction.operands[1]}],
                     static_cast<spv::Decoration>(instruction.operands[2]), instruction.operands.subspan(3));
      break;
    case spv::OpGroupDecorate:
      for (const Id target : instruction.operands.subspan(1))
        decorations_[target] = decorations(instruction.operands[0]);
      break;
    case spv::OpVariable: add_variable(instruction); break;
    default:
      if (instruction.op >= spv::OpTypeVoid && instruction.op <= spv::OpTypeForwardPointer)
        add_type(instruction);
      else if ((instruction.op >= spv::OpConstantTrue && instruction.op <= spv::OpSpecConstantOp) ||
               (instruction.op == spv::OpUndef && open_block_ == 0))
        add_constant(instruction);
      else add_to_function(instruction);
      break;
  }
}

/// Not refused here: an instruction that needs it has a line, and is met when the module is lowered.
void Module::add_capability(std::uint32_t capability) {
  if (harmless_capability(capability) || !unsupported_capability.empty()) return;
  const std::string instead = instead_of_capability(capability);
  unsupported_capability = fmt::format(
      "capability {} is not supported ({})", capability_name(capability),
      instead.empty() ? "vertex and fragment shaders of 32-bit types with uniform blocks and textures are"
                      : instead);
}

void Module::add_entry_point(const Instruction& instruction) {
  const spv::ExecutionModel wanted =
      stage_ == models::ShaderStage::kVertex ? spv::ExecutionModelVertex : spv::ExecutionModelFragment;
  const std::string name = literal_string(instruction.operands.subspan(2));
  const bool of_stage = instruction.operands[0] == static_cast<std::uint32_t>(wanted);
  if (of_stage && name == "main") entry_function_ = instruction.operands[1];
  else other_entry_points_.push_back(fmt::format("'{}'{}", name, of_stage ? "" : " of another stage"));
}

void Module::add_decoration(Decorations& target, spv::Decoration decoration,
                            std::span<const std::uint32_t> arguments) {
  const std::int64_t value = arguments.empty() ? 0 : arguments[0];
  switch (static_cast<std::uint32_t>(decoration)) {
    case spv::DecorationBuiltIn: target.built_in = value; break;
    case spv::DecorationLocation: target.location = value; break;
    case spv::DecorationComponent: target.component = value; break;
    case spv::DecorationBinding: target.binding = value; break;
    case spv::DecorationDescriptorSet: target.set = value; break;
    case spv::DecorationOffset: target.offset = value; break;
    case spv::DecorationArrayStride: target.array_stride = value; break;
    case spv::DecorationMatrixStride: target.matrix_stride = value; break;
    case spv::DecorationIndex: target.index = value; break;
    case spv::DecorationBufferBlock: target.buffer_block = true; break;
    case spv::DecorationRowMajor: target.row_major = true; break;
    case spv::DecorationFlat: target.flat = true; break;
    case spv::DecorationNoPerspective: target.no_perspective = true; break;
    case spv::DecorationCentroid: target.centroid = true; break;
    case spv::DecorationSample: target.sample = true; break;
    // precision, contraction and the like do not change what is computed here
    default: break;
  }
}

void Module::add_type(const Instruction& instruction) {
  const auto operands = instruction.operands;
  // The result of a type is its own id; the words after it are the operands.
  Type type;
  switch (static_cast<std::uint32_t>(instruction.op)) {
    case spv::OpTypeVoid: type.kind = Type::Kind::kVoid; break;
    case spv::OpTypeBool:
      type.kind = Type::Kind::kBool;
      type.scalars = 1;
      break;
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
      if (operands[0] != 32)
        wide_types_[instruction.result] =
            fmt::format("{}-bit {} are not supported by the shader compiler (32-bit ones are)", operands[0],
                        instruction.op == spv::OpTypeInt ? "integers"
                        : operands[0] == 64              ? "floats (double)"
                                                         : "floats");
      type.kind = instruction.op == spv::OpTypeInt ? Type::Kind::kInt : Type::Kind::kFloat;
      type.is_signed = instruction.op == spv::OpTypeInt && operands[1] != 0;
      type.scalars = 1;
      break;
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
      type.kind = instruction.op == spv::OpTypeVector ? Type::Kind::kVector : Type::Kind::kMatrix;
      type.element = operands[0];
      type.count = operands[1];
      type.scalars = saturating_product(this->type(type.element).scalars, type.count);
      if (const auto wide = wide_types_.find(type.element); wide != wide_types_.end())
        wide_types_[instruction.result] = wide->second;
      break;
    case spv::OpTypeArray: {
      const std::vector<std::uint32_t>* length = constant(operands[1]);
      if (length == nullptr || length->size() != 1)
        throw user_error("{}: the length of an array, {}, is not a constant", shader, name(operands[1]));
      type.kind = Type::Kind::kArray;
      type.element = operands[0];
      type.count = (*length)[0];
      type.scalars = saturating_product(this->type(type.element).scalars, type.count);
      break;
    }
    case spv::OpTypeRuntimeArray:
      type.kind = Type::Kind::kArray;
      type.element = operands[0];
      break;
    case spv::OpTypeStruct: {
      type.kind = Type::Kind::kStruct;
      type.members.assign(operands.begin(), operands.end());
      std::uint64_t sum = 0;
      for (const Id member : type.members) sum += this->type(member).scalars;
      type.scalars = saturating_product(sum, 1);
      break;
    }
    case spv::OpTypePointer:
      type.kind = Type::Kind::kPointer;
      type.element = operands[1];
      break;
    case spv::OpTypeImage:
      // Word order: sampled type, dimension, depth, arrayed, multisampled, sampled.
      type.kind = Type::Kind::kImage;
      type.element = operands[0];
      type.dim = operands[1];
      type.arrayed = operands[3] != 0;
      type.multisampled = operands[4] != 0;
      type.sampled = operands[5] == 1;
      break;
    case spv::OpTypeSampler: type.kind = Type::Kind::kSampler; break;
    case spv::OpTypeSampledImage:
      type.kind = Type::Kind::kSampledImage;
      type.element = operands[0];
      break;
    default: break;
  }
  types_[instruction.result] = std::move(type);
}

void Module::add_constant(const Instruction& instruction) {
  std::vector<std::uint32_t> value;
  switch (static_cast<std::uint32_t>(instruction.op)) {
    case spv::OpConstantTrue:
    case spv::OpSpecConstantTrue: value = {0xffffffffu}; break;
    case spv::OpConstantFalse:
    case spv::OpSpecConstantFalse: value = {0}; break;
    case spv::OpConstant:
    case spv::OpSpecConstant: value = {instruction.operands[0]}; break;
    case spv::OpConstantComposite:
    case spv::OpSpecConstantComposite:
      for (const Id part : instruction.operands) {
        const std::vector<std::uint32_t>* words = constant(part);
        if (words == nullptr)
          throw user_error("{}: constant {} has a part that is none", shader, name(instruction.result));
        value.insert(value.end(), words->begin(), words->end());
        if (value.size() > kMaxValueScalars)
          throw user_error("{}: constant {} has more than {} scalars", shader, name(instruction.result),
                           kMaxValueScalars);
      }
      break;
    case spv::OpConstantNull:
    case spv::OpUndef: {
      const std::uint32_t scalars = type(instruction.type).scalars;
      if (scalars > kMaxValueScalars)
        throw user_error("{}: constant {} has more than {} scalars", shader, name(instruction.result),
                         kMaxValueScalars);
      value.assign(scalars, 0);
      break;
    }
    case spv::OpSpecConstantOp: value = specialisation_constant(instruction); break;
    default:
      throw user_error(
          "{}", at(instruction, fmt::format("a constant by {} is not supported", name_of(instruction))));
  }
  constant_types_[instruction.result] = instruction.type;
  constants_[instruction.result] = std::move(value);
}

std::vector<std::uint32_t> Module::specialisation_constant(const Instruction& instruction) const {
  std::optional<std::vector<std::uint32_t>> value =
      evaluate_spec_constant(*this, instruction.operands, type(instruction.type).scalars);
  if (value) return *std::move(value);
  throw user_error(
      "{}", at(instruction,
               fmt::format(
                   "specialisation constant {}: its expression ({}) cannot be evaluated; compute it in main",
                   name(instruction.result), name_of(instruction))));
}

void Module::add_variable(const Instruction& instruction) {
  if (open_function_ != 0 && open_function_ != entry_function_) return;  // of another entry point
  Variable variable;
  variable.id = instruction.result;
  variable.type = type(instruction.type).element;
  variable.storage = static_cast<spv::StorageClass>(instruction.operands[0]);
  if (instruction.operands.size() > 1) variable.initializer = instruction.operands[1];
  variables.push_back(variable);
}

void Module::add_to_function(const Instruction& instruction) {
  if (instruction.op == spv::OpFunction) open_function_ = instruction.result;
  if (open_function_ != entry_function_) return;
  if (const auto wide = wide_types_.find(instruction.type); wide != wide_types_.end())
    throw user_error("{}", at(instruction, wide->second));
  switch (static_cast<std::uint32_t>(instruction.op)) {
    case spv::OpFunction:
    case spv::OpFunctionEnd: open_block_ = 0; break;
    case spv::OpLabel:
      open_block_ = instruction.result;
      if (entry == 0) entry = instruction.result;
      blocks[open_block_].label = open_block_;
      break;
    case spv::OpSelectionMerge:
    case spv::OpLoopMerge: {
      Block& open = blocks[open_block_];
      open.merge_kind = instruction.op;
      open.merge = instruction.operands[0];
      if (instruction.op == spv::OpSelectionMerge) break;
      open.continue_target = instruction.operands[1];
      open.loop_control = instruction.operands[2];
      break;
    }
    case spv::OpBranch:
    case spv::OpBranchConditional:
    case spv::OpSwitch:
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpKill:
    case spv::OpTerminateInvocation:
    case spv::OpUnreachable: blocks[open_block_].terminator = instruction; break;
    default:
      if (open_block_ != 0) blocks[open_block_].body.push_back(instruction);
      break;
  }
}

}  // namespace quadrille::pipeline::spirv
