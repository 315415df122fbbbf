/// Loads and stores: uniform blocks read constant words, local variables are registers, and an index known
/// only at run time becomes an indexed constant load (blocks and constant tables) or a chain of selections
/// (registers).
#include "pipeline/compiler/lowering.h"
#include "pipeline/compiler/spirv_names.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

using models::Op;
using Kind = spirv::Type::Kind;

constexpr std::uint32_t kMaxBlockWords = 65536;
constexpr std::uint64_t kMaxBufferBytes = std::uint64_t{1} << 31;  ///< that a constant index may reach
constexpr std::size_t kMaxSelectedPlaces = 64;  ///< elements that an index into registers may reach
constexpr std::uint32_t kMaxLocalScalars = 1024;

bool is_block(spv::StorageClass storage) {
  return storage == spv::StorageClassUniform || storage == spv::StorageClassPushConstant ||
         storage == spv::StorageClassStorageBuffer;
}

}  // namespace

/// Finds local variables that only ever hold one constant (tables that a shader indexes) and outputs that are
/// read back.
void Lowering::find_tables() {
  std::unordered_map<Id, Id> root;
  for (const auto& [id, variable] : variables_) root[id] = id;
  std::unordered_map<Id, int> stores;
  std::unordered_map<Id, Id> stored;
  std::vector<std::pair<Id, const spirv::Block*>> ordered;
  for (const auto& [label, block] : module_.blocks) ordered.emplace_back(label, &block);
  for (bool changed = true; changed;) {  // chains of chains may be met before their base
    changed = false;
    for (const auto& [label, block] : ordered)
      for (const spirv::Instruction& i : block->body)
        if ((i.op == spv::OpAccessChain || i.op == spv::OpInBoundsAccessChain || i.op == spv::OpCopyObject) &&
            !i.operands.empty() && root.contains(i.operands[0]) && !root.contains(i.result)) {
          root[i.result] = root[i.operands[0]];
          changed = true;
        }
  }
  for (const auto& [label, block] : ordered)
    for (const spirv::Instruction& i : block->body) {
      if (i.op != spv::OpStore && i.op != spv::OpLoad) continue;
      const auto found = root.find(i.operands[0]);
      if (found == root.end()) continue;
      if (i.op == spv::OpLoad) {
        if (variables_[found->second]->storage == spv::StorageClassOutput)
          read_outputs_.insert(found->second);
        continue;
      }
      ++stores[found->second];
      if (found->second == i.operands[0]) stored[found->second] = i.operands[1];
    }
  for (const spirv::Variable& variable : module_.variables) {
    if (variable.storage != spv::StorageClassFunction && variable.storage != spv::StorageClassPrivate)
      continue;
    if (module_.type(variable.type).kind != Kind::kArray) continue;
    const Id only = stores[variable.id] == 0                                ? variable.initializer
                    : stores[variable.id] == 1 && variable.initializer == 0 ? stored[variable.id]
                                                                            : 0;
    const std::vector<std::uint32_t>* words = only == 0 ? nullptr : module_.constant(only);
    if (words == nullptr) continue;
    ConstantBlock table;
    table.source = models::ConstantLayout::Source::kLiteral;
    table.literals = *words;
    const auto same = std::find(shader_.blocks.begin(), shader_.blocks.end(), table);
    tables_[variable.id] = static_cast<std::uint32_t>(same - shader_.blocks.begin());
    if (same == shader_.blocks.end()) shader_.blocks.push_back(table);
  }
}

void Lowering::declare(const spirv::Variable& variable) {
  Pointer p;
  p.storage = variable.storage;
  p.variable = variable.id;
  p.type = variable.type;
  switch (static_cast<std::uint32_t>(variable.storage)) {
    case spv::StorageClassUniformConstant: declare_texture(variable); return;
    case spv::StorageClassInput:
    case spv::StorageClassOutput: declare_interface(variable); break;
    case spv::StorageClassUniform:
      if (module_.type(variable.type).kind == Kind::kArray && module_.type(variable.type).count > 1)
        throw user_error(
            "{}", module_.at_use(variable.id, fmt::format("resource {} is an array of uniform blocks in a "
                                                          "use that is not supported (as a value, say)",
                                                          module_.name(variable.id))));
      if (module_.decorations(variable.type).buffer_block) p.storage = spv::StorageClassStorageBuffer;
      break;
    case spv::StorageClassStorageBuffer:
    case spv::StorageClassPushConstant: break;
    case spv::StorageClassFunction:
    case spv::StorageClassPrivate: {
      if (tables_.contains(variable.id)) break;
      const std::uint32_t scalars = module_.type(variable.type).scalars;
      if (scalars == 0 || scalars > kMaxLocalScalars)
        throw user_error(
            "{}",
            module_.at_use(variable.id, fmt::format("local variable {} has {} scalars; 1 to {} are supported",
                                                    module_.name(variable.id), scalars, kMaxLocalScalars)));
      Values& registers = memory_[variable.id];
      for (std::uint32_t k = 0; k < scalars; ++k) registers.push_back(build_.new_variable());
      if (const auto* words = variable.initializer == 0 ? nullptr : module_.constant(variable.initializer);
          words != nullptr)
        for (std::uint32_t k = 0; k < scalars && k < words->size(); ++k)
          build_.assign(registers[k], literal((*words)[k]));
      break;
    }
    default:
      throw user_error(
          "{}", module_.at_use(
                    variable.id,
                    fmt::format("variable {} has storage class {}, which is not supported ({})",
                                module_.name(variable.id), spirv::storage_class_name(variable.storage),
                                "use a uniform block, push constants, a buffer, inputs, outputs or locals")));
  }
  if (p.storage == spv::StorageClassStorageBuffer) declare_buffer(variable);
  pointers_[variable.id] = p;
}

const Lowering::Pointer& Lowering::pointer(Id id, const spirv::Instruction& i) const {
  const auto found = pointers_.find(id);
  if (found == pointers_.end()) throw unsupported(i, fmt::format("access through {}", module_.name(id)));
  return found->second;
}

void Lowering::access_chain(const spirv::Instruction& i) {
  Pointer p = pointer(i.operands[0], i);
  for (const Id index : i.operands.subspan(1)) step(p, index, i);
  pointers_[i.result] = p;
}

/// One index of an access chain.
void Lowering::step(Pointer& p, Id index, const spirv::Instruction& i) {
  const spirv::Type& type = module_.type(p.type);
  const bool block = is_block(p.storage);
  const Value at = scalar(index);
  if (type.kind == Kind::kStruct) {
    if (!at.is_literal() || at.bits >= type.members.size())
      throw unsupported(i, "a structure member that is not a constant");
    const spirv::Decorations& d = module_.member_decorations(p.type, at.bits);
    if (block) {
      p.offset += static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.offset));
      p.row_major = d.row_major;
      p.matrix_stride = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.matrix_stride));
    } else {
      for (std::uint32_t k = 0; k < at.bits; ++k) p.offset += module_.type(type.members[k]).scalars;
    }
    p.type = type.members[at.bits];
    return;
  }
  std::uint32_t stride = 0;
  if (type.kind == Kind::kArray) {
    stride =
        block
            ? static_cast<std::uint32_t>(std::max<std::int64_t>(0, module_.decorations(p.type).array_stride))
            : module_.type(type.element).scalars;
  } else if (type.kind == Kind::kMatrix) {
    stride = !block ? module_.type(type.element).scalars : p.row_major ? 4 : p.matrix_stride;
    p.element_stride = block && p.row_major ? p.matrix_stride : 4;
  } else if (type.kind == Kind::kVector) {
    stride = block ? p.element_stride : 1;
  } else {
    throw unsupported(i, "indexing this type");
  }
  if (at.is_literal()) {
    const bool buffer = p.storage == spv::StorageClassStorageBuffer;
    const std::uint32_t last = type.count != 0 ? type.count - 1 : buffer ? at.bits : 0;
    const std::uint64_t offset = p.offset + std::uint64_t{stride} * std::min(at.bits, last);
    const std::uint64_t most = buffer ? kMaxBufferBytes : kMaxBlockWords * 4;
    if (offset >= most) throw unsupported(i, fmt::format("an offset of more than {} bytes", most));
    p.offset = static_cast<std::uint32_t>(offset);
  } else {
    p.dynamic.push_back({at, stride, type.count});
  }
  p.type = type.element;
}

/// Sum of the run-time indices times their strides, in units of `unit`.
Value Lowering::dynamic_offset(const Pointer& p, std::uint32_t unit) {
  Value sum = literal(0u);
  for (const Index& index : p.dynamic)
    sum = build_.iadd(build_.emit(Op::kIMul, index.value, literal(index.stride / unit)), sum);
  return sum;
}

void Lowering::load(const spirv::Instruction& i) {
  if (const auto texture = textures_.find(i.operands[0]); texture != textures_.end()) {
    textures_[i.result] = texture->second;
    return;
  }
  if (const auto sampler = samplers_.find(i.operands[0]); sampler != samplers_.end()) {
    samplers_[i.result] = sampler->second;
    return;
  }
  const Pointer& p = pointer(i.operands[0], i);
  if (p.type != i.type) throw unsupported(i, "a load of another type than was declared");
  if (is_block(p.storage)) {
    Values words;
    visit_words(p, i, [&](const Pointer& word) {
      words.push_back(word.storage == spv::StorageClassStorageBuffer ? load_word(word, i)
                                                                     : block_word(word, i));
    });
    const spirv::Type& type = module_.type(p.type);
    if (type.kind == Kind::kMatrix && p.row_major) transposed_.insert(i.result);
    return define(i, std::move(words));
  }
  define(i, load_scalars(p, i));
}

std::uint32_t Lowering::block_of(const Pointer& p) {
  ConstantBlock block;
  if (p.storage == spv::StorageClassPushConstant) {
    block.source = models::ConstantLayout::Source::kPushConstant;
  } else {
    const spirv::Decorations& d = module_.decorations(p.variable);
    block.set = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.set));
    block.binding = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.binding));
  }
  const auto found = std::find(shader_.blocks.begin(), shader_.blocks.end(), block);
  const auto index = static_cast<std::uint32_t>(found - shader_.blocks.begin());
  if (found == shader_.blocks.end()) shader_.blocks.push_back(block);
  return index;
}

/// Calls `visit` with the place of each word of a value in a block, following offsets and strides. [VK1.3
/// #interfaces-resources-layout]
void Lowering::visit_words(const Pointer& p, const spirv::Instruction& i, const WordVisitor& visit) const {
  const spirv::Type& type = module_.type(p.type);
  if (type.kind == Kind::kBool) throw unsupported(i, "a bool in a block");
  if (type.kind == Kind::kInt || type.kind == Kind::kFloat) return visit(p);
  const bool is_struct = type.kind == Kind::kStruct;
  if (!is_struct && type.kind != Kind::kArray && type.kind != Kind::kMatrix && type.kind != Kind::kVector)
    throw unsupported(i, "a load of this type");
  const std::uint32_t parts = is_struct ? static_cast<std::uint32_t>(type.members.size()) : type.count;
  if (parts == 0) throw unsupported(i, "a value of unknown length");
  for (std::uint32_t k = 0; k < parts; ++k) {
    Pointer part = p;
    if (is_struct) {
      const spirv::Decorations& d = module_.member_decorations(p.type, k);
      part.offset += static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.offset));
      part.row_major = d.row_major;
      part.matrix_stride = static_cast<std::uint32_t>(std::max<std::int64_t>(0, d.matrix_stride));
      part.type = type.members[k];
    } else {
      const std::uint32_t stride = type.kind == Kind::kArray
                                       ? static_cast<std::uint32_t>(std::max<std::int64_t>(
                                             0, module_.decorations(p.type).array_stride))
                                   : type.kind == Kind::kVector ? p.element_stride
                                   : p.row_major                ? 4
                                                                : p.matrix_stride;
      if (type.kind == Kind::kMatrix) part.element_stride = p.row_major ? p.matrix_stride : 4;
      part.offset += stride * k;
      part.type = type.element;
    }
    visit_words(part, i, visit);
  }
}

Value Lowering::block_word(const Pointer& p, const spirv::Instruction& i) {
  std::uint64_t reach = p.offset;
  bool aligned = p.offset % 4 == 0;
  for (const Index& index : p.dynamic) {
    reach += std::uint64_t{index.stride} * (index.count == 0 ? 0 : index.count - 1);
    aligned = aligned && index.stride % 4 == 0;
  }
  if (!aligned) throw unsupported(i, "a block layout that is not a multiple of 4 bytes");
  if (reach / 4 >= kMaxBlockWords)
    throw unsupported(i, fmt::format("a block of more than {} words", kMaxBlockWords));
  const std::uint32_t block = block_of(p);
  if (p.dynamic.empty()) return uniform_word(block, p.offset / 4);
  const std::uint32_t largest = (static_cast<std::uint32_t>(reach) - p.offset) / 4;
  const Value at = dynamic_offset(p, 4);
  if (at.is_literal()) return uniform_word(block, p.offset / 4 + std::min(at.bits, largest));
  return build_.emit(Op::kLoadConst, at, literal(largest), uniform_word(block, p.offset / 4));
}

/// The scalars at which a pointer may point, in order of its run-time indices.
std::vector<std::uint32_t> Lowering::places(const Pointer& p, const spirv::Instruction& i) const {
  std::vector<std::uint32_t> result{p.offset};
  for (const Index& index : p.dynamic) {
    if (result.size() * index.count > kMaxSelectedPlaces)
      throw unsupported(i, fmt::format("an index into a local array (or input) of more than {} elements",
                                       kMaxSelectedPlaces));
    std::vector<std::uint32_t> next;
    for (const std::uint32_t base : result)
      for (std::uint32_t k = 0; k < index.count; ++k) next.push_back(base + k * index.stride);
    result = std::move(next);
  }
  return result;
}

Value Lowering::load_scalar(const Pointer& p, std::uint32_t place, const spirv::Instruction& i) {
  if (p.storage == spv::StorageClassInput) return load_input(p.variable, place, i);
  if (const auto table = tables_.find(p.variable); table != tables_.end())
    return literal(shader_.blocks[table->second].literals.at(place));
  return build_.read(memory_[p.variable].at(place));
}

Values Lowering::load_scalars(const Pointer& p, const spirv::Instruction& i) {
  Values result;
  const std::uint32_t scalars = module_.type(p.type).scalars;
  if (const auto table = tables_.find(p.variable); table != tables_.end() && !p.dynamic.empty()) {
    std::uint32_t largest = 0;
    for (const Index& index : p.dynamic) largest += index.stride * (index.count == 0 ? 0 : index.count - 1);
    const Value at = dynamic_offset(p, 1);
    for (std::uint32_t k = 0; k < scalars; ++k)
      result.push_back(
          build_.emit(Op::kLoadConst, at, literal(largest), uniform_word(table->second, p.offset + k)));
    return result;
  }
  const std::vector<std::uint32_t> candidates = places(p, i);
  const Value at = dynamic_offset(p, 1);
  for (std::uint32_t k = 0; k < scalars; ++k) {
    Value chosen = load_scalar(p, candidates[0] + k, i);
    for (std::size_t c = 1; c < candidates.size(); ++c)
      chosen = build_.select(build_.emit(Op::kIEq, at, literal(candidates[c] - p.offset)),
                             load_scalar(p, candidates[c] + k, i), chosen);
    result.push_back(chosen);
  }
  return result;
}

void Lowering::store(const spirv::Instruction& i) {
  const Pointer& p = pointer(i.operands[0], i);
  if (p.storage == spv::StorageClassStorageBuffer) return store_words(p, value(i.operands[1]), i);
  if (!tables_.contains(p.variable)) store_values(p, value(i.operands[1]), i);
}

void Lowering::store_values(const Pointer& p, const Values& values, const spirv::Instruction& i) {
  const std::vector<std::uint32_t> candidates = places(p, i);
  if (p.storage == spv::StorageClassOutput && candidates.size() == 1 && !memory_.contains(p.variable)) {
    for (std::uint32_t k = 0; k < values.size(); ++k) store_output(p, p.offset + k, values[k], i);
    return;
  }
  const auto memory = memory_.find(p.variable);
  if (memory == memory_.end()) throw unsupported(i, "a store to what is not a variable or output");
  const Value at = dynamic_offset(p, 1);
  for (const std::uint32_t place : candidates)
    for (std::uint32_t k = 0; k < values.size(); ++k) {
      const Value target = memory->second.at(place + k);
      Value stored = values[k];
      if (candidates.size() > 1)
        stored =
            build_.select(build_.emit(Op::kIEq, at, literal(place - p.offset)), stored, build_.read(target));
      build_.assign(target, stored);
      if (p.storage == spv::StorageClassOutput) store_output(p, place + k, stored, i);
    }
}

}  // namespace quadrille::pipeline
