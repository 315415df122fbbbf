#include "pipeline/compiler/spirv_optimise.h"

#include "models/base/error.h"
#include "pipeline/compiler/spirv_descriptor_arrays.h"
#include "pipeline/compiler/spirv_loops.h"
#include "pipeline/compiler/spirv_module.h"
#include "pipeline/compiler/spirv_returning_kills.h"
#include "pipeline/compiler/spirv_words.h"

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace quadrille::pipeline {
namespace {

constexpr spv_target_env kEnvironment = SPV_ENV_VULKAN_1_3;

/// The first line of the first message, which names the instruction and the rule.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void validate(std::span<const std::uint32_t> words, std::string_view shader) {
  if (words.size() < 5 || words.size() > kMaxModuleWords)
    throw user_error("{}: a SPIR-V module has 5 to {} words, this one has {}", shader, kMaxModuleWords,
                     words.size());
  if (words[0] != spv::MagicNumber)
    throw user_error("{}: not SPIR-V (first word {:#010x} instead of {:#010x})", shader, words[0],
                     spv::MagicNumber + 0u);
  std::string message;
  spvtools::SpirvTools tools(kEnvironment);
  tools.SetMessageConsumer(
      [&](spv_message_level_t, const char*, const spv_position_t& position, const char* text) {
        if (message.empty()) message = fmt::format("{} (word {})", first_line(text), position.index);
      });
  spvtools::ValidatorOptions options;
  options.SetScalarBlockLayout(true);  // blocks are read word by word, whatever their alignment
  if (!tools.Validate(words.data(), words.size(), options))
    throw user_error("{}: not valid SPIR-V: {}", shader, message);
}

/// Instructions of a function with every call expanded, saturating. The validator has refused recursion.
class ExpandedSize {
 public:
  explicit ExpandedSize(std::span<const std::uint32_t> words) {
    std::uint32_t function = 0;
    for (const auto& [at, count] : layout_of(words)) {
      const spv::Op op = opcode(words, at);
      if (op == spv::OpFunction) function = words[at + 2];
      if (function == 0) continue;
      ++own_[function];
      if (op == spv::OpFunctionCall) calls_[function].push_back(words[at + 3]);
    }
  }
  std::uint64_t largest() {
    std::uint64_t result = 0;
    for (const auto& entry : own_) result = std::max(result, of(entry.first, 0));
    return result;
  }

 private:
  std::uint64_t of(std::uint32_t function, int depth) {
    constexpr std::uint64_t kTooMany = kMaxInlinedInstructions + 1;
    if (depth > 200) return kTooMany;
    if (const auto known = total_.find(function); known != total_.end()) return known->second;
    std::uint64_t sum = own_[function];
    for (const std::uint32_t callee : calls_[function]) sum = std::min(kTooMany, sum + of(callee, depth + 1));
    total_[function] = sum;
    return sum;
  }
  std::unordered_map<std::uint32_t, std::uint64_t> own_, total_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> calls_;
};

bool is_annotation(spv::Op op) {
  return op == spv::OpDecorate || op == spv::OpMemberDecorate || op == spv::OpDecorationGroup ||
         op == spv::OpGroupDecorate || op == spv::OpGroupMemberDecorate || op == spv::OpDecorateId ||
         op == spv::OpDecorateString || op == spv::OpMemberDecorateString;
}

bool is_declaration(spv::Op op) {
  return (op >= spv::OpTypeVoid && op <= spv::OpTypeForwardPointer) ||
         (op >= spv::OpConstantTrue && op <= spv::OpSpecConstantOp) || op == spv::OpVariable ||
         op == spv::OpUndef || op == spv::OpFunction || op == spv::OpLine || op == spv::OpNoLine;
}

/// Float results: arithmetic and extended instructions whose type is a float, a vector or a matrix of floats.
std::vector<std::uint32_t> float_results(std::span<const std::uint32_t> words, const Layout& layout) {
  std::unordered_set<std::uint32_t> float_types, marked;
  std::vector<std::uint32_t> results;
  for (const auto& [at, count] : layout) {
    const spv::Op op = opcode(words, at);
    if (op == spv::OpDecorate && count >= 3 && words[at + 2] == spv::DecorationNoContraction)
      marked.insert(words[at + 1]);
    if (op == spv::OpTypeFloat) float_types.insert(words[at + 1]);
    if ((op == spv::OpTypeVector || op == spv::OpTypeMatrix) && float_types.contains(words[at + 2]))
      float_types.insert(words[at + 1]);
    const bool arithmetic = (op >= spv::OpSNegate && op <= spv::OpDot) || op == spv::OpExtInst;
    if (arithmetic && float_types.contains(words[at + 1]) && !marked.contains(words[at + 2]))
      results.push_back(words[at + 2]);
  }
  return results;
}

std::vector<std::uint32_t> forbid_float_rewrites(std::span<const std::uint32_t> words) {
  const Layout layout = layout_of(words);
  std::size_t place = words.size();
  for (const auto& [at, count] : layout) {
    if (!is_annotation(opcode(words, at)) && !is_declaration(opcode(words, at))) continue;
    place = at;
    break;
  }
  std::vector<std::uint32_t> out(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(place));
  for (const std::uint32_t id : float_results(words, layout)) {
    out.push_back(3u << 16 | spv::OpDecorate);
    out.push_back(id);
    out.push_back(spv::DecorationNoContraction);
  }
  out.insert(out.end(), words.begin() + static_cast<std::ptrdiff_t>(place), words.end());
  return out;
}

void register_passes(spvtools::Optimizer& optimizer, bool descriptor_arrays) {
  using namespace spvtools;
  optimizer.RegisterPass(CreateFreezeSpecConstantValuePass())
      .RegisterPass(CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPass(CreateDeadBranchElimPass())
      .RegisterPass(CreateMergeReturnPass())
      .RegisterPass(CreateInlineExhaustivePass())
      .RegisterPass(CreateEliminateDeadFunctionsPass())
      .RegisterPass(CreateAggressiveDCEPass())
      .RegisterPass(CreatePrivateToLocalPass())
      .RegisterPass(CreateScalarReplacementPass(128))
      .RegisterPass(CreateLocalAccessChainConvertPass())
      .RegisterPass(CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(CreateLocalSingleStoreElimPass())
      .RegisterPass(CreateSSARewritePass())
      .RegisterPass(CreateCopyPropagateArraysPass())
      .RegisterPass(CreateScalarReplacementPass(128))
      .RegisterPass(CreateLocalAccessChainConvertPass())
      .RegisterPass(CreateSSARewritePass())
      .RegisterPass(CreateCCPPass())
      .RegisterPass(CreateDeadBranchElimPass())
      .RegisterPass(CreateAggressiveDCEPass());
  if (descriptor_arrays) register_descriptor_array_passes(optimizer);
  optimizer.RegisterPass(CreateBlockMergePass())
      .RegisterPass(CreateCFGCleanupPass())
      .RegisterPass(CreateAggressiveDCEPass());
}

}  // namespace

OptimisedSpirv optimise_spirv(std::span<const std::uint32_t> words, std::string_view shader) {
  validate(words, shader);
  refuse_endless_loops(words, shader);
  if (ExpandedSize(words).largest() > kMaxInlinedInstructions)
    throw user_error("{}: more than {} instructions once every call is expanded in place", shader,
                     kMaxInlinedInstructions);
  ReturningKills kills = let_kills_return({words.begin(), words.end()});
  std::vector<std::uint32_t> input = forbid_float_rewrites(kills.words);
  const bool descriptor_arrays = has_descriptor_arrays(input, shader);
  if (descriptor_arrays) spread_bindings(input, shader);
  std::string message;
  spvtools::Optimizer optimizer(kEnvironment);
  optimizer.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (message.empty() && level <= SPV_MSG_ERROR) message = first_line(text);
      });
  register_passes(optimizer, descriptor_arrays);
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  std::vector<std::uint32_t> output;
  const bool done = optimizer.Run(input.data(), input.size(), &output, options);
  if (!done && descriptor_arrays && message.find("cannot be replaced") != std::string::npos)
    throw user_error(
        "{}: an array of buffers with an index that is not a constant is not supported, nor one "
        "that is used as a whole",
        shader);
  if (!done) throw user_error("{}: SPIRV-Tools cannot optimise it: {}", shader, message);
  if (descriptor_arrays) name_elements(output);
  validate(output, shader);
  return {std::move(output), kills.any};
}

}  // namespace quadrille::pipeline
