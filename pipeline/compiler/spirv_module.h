/// A SPIR-V module as the lowering reads it: types, constants, decorations and the blocks of the one function
/// that is left after optimisation.
#pragma once

#include "models/base/pipeline_state.h"

#ifndef SPV_ENABLE_UTILITY_CODE
#define SPV_ENABLE_UTILITY_CODE
#endif
#include <spirv/unified1/spirv.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace quadrille::pipeline::spirv {

using Id = std::uint32_t;

struct Type {
  enum class Kind : std::uint8_t {
    kVoid,
    kBool,
    kInt,
    kFloat,
    kVector,
    kMatrix,
    kArray,  ///< of `count` elements; 0: as many as its buffer holds
    kStruct,
    kPointer,
    kImage,
    kSampler,
    kSampledImage,
    kOther
  };
  Kind kind = Kind::kOther;
  bool is_signed = false;
  Id element = 0;           ///< component, column, array element, pointee or image
  std::uint32_t count = 0;  ///< components, columns or array elements
  std::vector<Id> members;  ///< struct
  /// image: spv::Dim, and what OpTypeImage says of it; `element` is its sampled type
  std::uint32_t dim = 0;
  bool arrayed = false, multisampled = false, sampled = false;
  std::uint32_t scalars = 0;  ///< 32-bit scalars in a value of this type, flattened; 0 for what has none
};

/// Decorations of an id or of a struct member that the compiler reads. -1: not decorated.
struct Decorations {
  std::int64_t built_in = -1, location = -1, component = -1, binding = -1, set = -1, offset = -1,
               array_stride = -1, matrix_stride = -1, index = -1;
  bool row_major = false, flat = false, no_perspective = false, centroid = false, sample = false,
       buffer_block = false;
};

struct Instruction {
  spv::Op op = spv::OpNop;
  Id type = 0, result = 0;
  std::span<const std::uint32_t> operands;  ///< after result type and result
  std::uint32_t line = 0;                   ///< of the nearest OpLine, 0: unknown
};

struct Block {
  Id label = 0;
  std::vector<Instruction> body;  ///< without label, merge and terminator
  Instruction terminator;
  spv::Op merge_kind = spv::OpNop;  ///< OpSelectionMerge, OpLoopMerge or none
  Id merge = 0, continue_target = 0;
  std::uint32_t loop_control = 0;  ///< spv::LoopControlMask
};

/// Labels that the block's end leads to.
[[nodiscard]] std::vector<Id> successors(const Block& block);

struct Variable {
  Id id = 0, type = 0;  ///< `type` is the pointee
  spv::StorageClass storage = spv::StorageClassFunction;
  Id initializer = 0;
};

/// Most scalars in one value; larger ones are refused.
inline constexpr std::uint32_t kMaxValueScalars = 4096;

class Module {
 public:
  /// Reads an optimised, valid module. Throws `UserError` naming `shader` for what the compiler cannot take:
  /// types of other than 32 bits, several functions, no entry point "main" of the stage.
  Module(std::vector<std::uint32_t> words, models::ShaderStage stage, std::string_view shader);

  [[nodiscard]] const Type& type(Id id) const;
  [[nodiscard]] const Decorations& decorations(Id id) const;
  [[nodiscard]] const Decorations& member_decorations(Id type, std::uint32_t member) const;
  [[nodiscard]] const Block& block(Id label) const;
  /// The value of a constant, flattened to words; null if `id` is none.
  [[nodiscard]] const std::vector<std::uint32_t>* constant(Id id) const;
  [[nodiscard]] Id constant_type(Id id) const;
  /// Quoted OpName of an id, or its number.
  [[nodiscard]] std::string name(Id id) const;
  /// Builds "shader:line: text"; the line is left out where the module has none.
  [[nodiscard]] std::string at(const Instruction& instruction, std::string_view text) const;
  /// The same with the first line of the entry point that reads or writes the variable `id`.
  [[nodiscard]] std::string at_use(Id id, std::string_view text) const;

  std::string shader;
  Id entry = 0;                     ///< label of the first block
  std::vector<Variable> variables;  ///< module scope and function scope
  std::unordered_map<Id, Block> blocks;
  std::unordered_map<Id, Id> glsl_imports;  ///< ids of OpExtInstImport "GLSL.std.450"
  bool early_fragment_tests = false;
  bool kills_return = false;  ///< a demotion stands for a discard (spirv_returning_kills.h)
  /// what is wrong with it; the module must be refused, if nothing that needs it was
  std::string unsupported_capability;
  Id bound = 0;

 private:
  void add(const Instruction& given);
  void add_type(const Instruction& instruction);
  void add_constant(const Instruction& instruction);
  void add_decoration(Decorations& target, spv::Decoration decoration,
                      std::span<const std::uint32_t> arguments);
  void add_variable(const Instruction& instruction);
  void add_entry_point(const Instruction& instruction);
  void add_capability(std::uint32_t capability);
  [[nodiscard]] std::vector<std::uint32_t> specialisation_constant(const Instruction& instruction) const;
  void add_to_function(const Instruction& instruction);

  std::vector<std::uint32_t> words_;
  models::ShaderStage stage_;
  std::unordered_map<Id, Type> types_;
  std::unordered_map<Id, std::vector<std::uint32_t>> constants_;
  std::unordered_map<Id, Id> constant_types_;
  std::unordered_map<Id, Decorations> decorations_;
  std::map<std::pair<Id, std::uint32_t>, Decorations> member_decorations_;
  std::unordered_map<Id, std::string> names_;
  Id entry_function_ = 0, open_function_ = 0, open_block_ = 0;
  std::uint32_t line_ = 0;
  /// types of other than 32 bits and vectors of them: why they are refused
  std::map<Id, std::string> wide_types_;
  std::vector<std::string> other_entry_points_;
};

}  // namespace quadrille::pipeline::spirv
