/// What a draw has to know of a shader, read off its instructions.
#include <algorithm>
#include <set>

#include "traces/capture/shader_words.h"
#include "traces/capture/spirv_parts.h"

namespace quadrille::capture {
namespace {

/// Where the instruction has the pointer that it writes to: a word of it, or 0 if it writes nowhere.
std::size_t written_operand(Instruction i) {
  const std::uint32_t op = op_of(i);
  if (op == kStore || op == kCopyMemory || op == kAtomicStore) return 1;
  const bool atomic = (op >= kFirstAtomic && op <= kLastAtomic) || op == kAtomicFMin || op == kAtomicFMax ||
                      op == kAtomicFAdd;
  return atomic ? 3 : 0;
}

/// Follows pointers from variables to where they are written through. What a function is given counts as
/// written.
class Pointers {
 public:
  void note(Instruction i) {
    const std::uint32_t op = op_of(i);
    if (op == kVariable && i.size() > 3) variable_[i[2]] = i[2];
    if (op == kAccessChain || op == kInBoundsAccessChain || op == kPtrAccessChain || op == kCopyObject)
      follow(i, 3, 4);
    if (op == kSelect) follow(i, 4, 6);
    if (op == kPhi) follow(i, 3, i.size());
    if (op == kFunctionCall)
      for (std::size_t w = 4; w < i.size(); ++w) write(i[w]);
    if (const std::size_t operand = written_operand(i); operand != 0 && operand < i.size()) write(i[operand]);
  }
  [[nodiscard]] const std::set<std::uint32_t>& written() const { return written_; }

 private:
  void follow(Instruction i, std::size_t first, std::size_t end) {
    for (std::size_t w = first; w < std::min(end, i.size()); ++w)
      if (const auto found = variable_.find(i[w]); found != variable_.end()) variable_[i[2]] = found->second;
  }
  void write(std::uint32_t pointer) {
    if (const auto found = variable_.find(pointer); found != variable_.end()) written_.insert(found->second);
  }

  std::map<std::uint32_t, std::uint32_t> variable_;  ///< that a pointer, by its id, points into
  std::set<std::uint32_t> written_;
};

}  // namespace

ShaderFacts shader_facts(std::span<const std::uint32_t> words) {
  ShaderFacts facts;
  Pointers pointers;
  // By id: sets and bindings; values of constants; lengths of arrays, of what is pointed to, of variables.
  std::map<std::uint32_t, std::uint32_t> sets, bindings, constants, lengths;
  for (const Instruction i : split(words)) {
    pointers.note(i);
    if (op_of(i) == kConstant && i.size() == 4) constants[i[2]] = i[3];
    if (op_of(i) == kTypeArray && i.size() == 4) lengths[i[1]] = constants[i[3]];
    if (op_of(i) == kTypePointer && i.size() == 4 && lengths.contains(i[3])) lengths[i[1]] = lengths[i[3]];
    if (op_of(i) == kVariable && i.size() > 3 && lengths.contains(i[1])) lengths[i[2]] = lengths[i[1]];
    if (op_of(i) != kDecorate || i.size() < 3) continue;
    if (i[2] == kFlat) facts.flat_input = true;
    if (i.size() == 4 && i[2] == kDescriptorSet) sets[i[1]] = i[3];
    if (i.size() == 4 && i[2] == kBinding) bindings[i[1]] = i[3];
  }
  for (const auto& [id, binding] : bindings) {
    const auto length = lengths.find(id);
    std::uint32_t& count = facts.bindings[{sets[id], binding}];
    count = std::max(count, length == lengths.end() ? 1 : length->second);
    if (pointers.written().contains(id)) facts.written.insert({sets[id], binding});
  }
  return facts;
}

}  // namespace quadrille::capture
