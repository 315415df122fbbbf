#include "pipeline/compiler/lower.h"

#include "pipeline/compiler/lowering.h"
#include "pipeline/compiler/spirv_names.h"

namespace quadrille::pipeline {
namespace {

constexpr std::size_t kMaxScalarCode = 60000;

}  // namespace

ScalarShader lower_shader(const spirv::Module& module, models::ShaderStage stage) {
  Attempts attempts;
  for (;;) {
    try {
      return Lowering(module, stage, attempts).run();
    } catch (const StartAgain& again) {
      QUADRILLE_CHECK((attempts.*again.set).insert(again.header).second,
                      "block %{} was lowered that way already", again.header);
    }
  }
}

Lowering::Lowering(const spirv::Module& module, models::ShaderStage stage, const Attempts& attempts)
    : module_(module), attempts_(attempts) {
  shader_.stage = stage;
  shader_.name = module.shader;
  shader_.early_fragment_tests = module.early_fragment_tests;
}

ScalarShader Lowering::run() {
  for (const spirv::Variable& variable : module_.variables) variables_[variable.id] = &variable;
  find_tables();
  for (const spirv::Variable& variable : module_.variables) declare(variable);
  if (module_.kills_return) {
    killed_ = build_.new_variable();
    build_.assign(killed_, literal(0u));
  }
  region(module_.entry, {});
  build_.effect(models::Op::kEnd);
  return std::move(shader_);
}

const Values& Lowering::value(Id id) {
  if (const auto found = values_.find(id); found != values_.end()) return found->second;
  const std::vector<std::uint32_t>* constant = module_.constant(id);
  if (constant == nullptr || constant->empty())
    throw user_error("{}: {} has no value that the compiler can use", module_.shader, module_.name(id));
  Values& words = values_[id];
  for (const std::uint32_t word : *constant) words.push_back(literal(word));
  return words;
}

void Lowering::define(const spirv::Instruction& i, Values values) { values_[i.result] = std::move(values); }

UserError Lowering::unsupported(const spirv::Instruction& i, std::string_view what) const {
  return user_error("{}", module_.at(i, fmt::format("{} is not supported by the shader compiler", what)));
}

Id Lowering::value_type(Id id) const {
  const auto found = value_types_.find(id);
  return found != value_types_.end() ? found->second : module_.constant_type(id);
}

void Lowering::check_size(const spirv::Instruction& i) {
  if (i.type != 0 && module_.type(i.type).scalars > spirv::kMaxValueScalars)
    throw unsupported(i, fmt::format("a value of more than {} scalars", spirv::kMaxValueScalars));
  if (shader_.code.size() <= kMaxScalarCode) return;
  roll_a_loop();
  throw unsupported(i, fmt::format("a program of more than {} scalar instructions", kMaxScalarCode));
}

void Lowering::instruction(const spirv::Instruction& i) {
  check_size(i);
  value_types_[i.result] = i.type;
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpPhi:
    case spv::OpNop:
    case spv::OpVariable:
    case spv::OpLine:
    case spv::OpNoLine: return;
    case spv::OpUndef: return define(i, Values(module_.type(i.type).scalars, literal(0u)));
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain: return access_chain(i);
    case spv::OpLoad: return load(i);
    case spv::OpStore: return store(i);
    case spv::OpExtInst: return glsl450(i);
    case spv::OpDemoteToHelperInvocation:
      build_.effect(models::Op::kKillIf, literal(kTrue));
      if (module_.kills_return) build_.assign(killed_, literal(kTrue));
      return;
    default: break;
  }
  if (!arithmetic(i) && !bit_operation(i) && !comparison(i) && !composite(i) && !matrix(i) && !image(i) &&
      !storage(i))
    throw unsupported(i, spirv::name_of(i));
}

}  // namespace quadrille::pipeline
