/// A SPIR-V module as tables: types, constants, decorations, and functions as lists of blocks. Validated
/// first, so that readers may trust its structure.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::models::reference {

using Id = std::uint32_t;
inline constexpr std::uint32_t kNoNumber = 0xffffffffu;

/// One instruction: its opcode (`spv::Op`), the ids of type and result (0: none) and its other words.
struct SpirvInstruction {
  std::uint32_t op = 0;
  Id type = 0, result = 0;
  std::vector<std::uint32_t> words;
};

enum class TypeKind : std::uint8_t {
  kVoid,
  kBool,
  kInt,
  kFloat,
  kVector,
  kMatrix,
  kArray,
  kStruct,
  kPointer,
  kImage,
  kSampler,
  kSampledImage,
  kFunction,
  kUnsupported
};

struct SpirvType {
  TypeKind kind = TypeKind::kVoid;
  /// vector, matrix (its column), array, pointer, sampled image, function (its result)
  Id element = 0;
  std::uint32_t count = 0;    ///< vector, matrix, array: elements
  bool is_signed = false;     ///< int
  std::uint32_t storage = 0;  ///< pointer: `spv::StorageClass`
  std::vector<Id> members;    ///< struct
  std::uint32_t cells = 0;    ///< scalars in a value of this type (0: not a value)
  std::string_view problem;   ///< kUnsupported: what it is
};

/// Decorations of an id, or of one member of a struct. `kNoNumber` where absent.
struct Decorations {
  std::uint32_t builtin = kNoNumber, location = kNoNumber, component = kNoNumber, binding = kNoNumber,
                set = kNoNumber;
  std::uint32_t offset = kNoNumber, array_stride = kNoNumber, matrix_stride = kNoNumber;
  std::uint32_t index = 0;  ///< of a fragment shader's output
  bool row_major = false, flat = false, no_perspective = false, centroid = false, sample = false;
};

struct SpirvBlock {
  Id label = 0;
  Id merge = 0;          ///< of OpSelectionMerge or OpLoopMerge; 0: none
  Id loop_continue = 0;  ///< of OpLoopMerge; 0: none
  std::vector<SpirvInstruction> phis;
  std::vector<SpirvInstruction> body;  ///< without label, phis, merge instruction and terminator
  SpirvInstruction terminator;
};

struct SpirvFunction {
  Id id = 0;
  std::vector<Id> parameters;
  std::vector<SpirvBlock> blocks;
};

struct SpirvModule {
  std::string name;                      ///< of the shader, for messages
  std::vector<SpirvType> types;          ///< by id
  std::vector<Decorations> decorations;  ///< by id
  std::map<std::pair<Id, std::uint32_t>, Decorations> member_decorations;
  std::vector<SpirvInstruction> globals;  ///< constants and variables, in order
  std::unordered_map<Id, SpirvFunction> functions;
  Id glsl_import = 0;  ///< of "GLSL.std.450"; 0: none
  Id entry = 0;        ///< function of the entry point "main"
  bool early_fragment_tests = false;
  bool origin_upper_left = true;

  [[nodiscard]] const SpirvType& type(Id id) const { return types[id]; }
  [[nodiscard]] Decorations member(Id struct_type, std::uint32_t index) const;
  /// The scalar type at the bottom of a scalar, vector or matrix type.
  [[nodiscard]] const SpirvType& scalar_of(Id id) const;
};

/// Validates (Vulkan rules) and reads a module with entry point "main" for the stage. Throws `UserError`
/// naming the shader.
[[nodiscard]] SpirvModule read_spirv(const traces::Shader& shader);

/// The blocks of a function so ordered that a construct's blocks stand between its header and its merge
/// block, and a loop's body before its continue block: lanes that wait at the block of lowest order meet
/// again as early as possible. Blocks that cannot be reached are left out. Returns indices into `blocks`.
[[nodiscard]] std::vector<std::size_t> structured_order(const SpirvFunction& function);

/// Labels a terminator can go to.
[[nodiscard]] std::vector<Id> successors(const SpirvInstruction& terminator);

}  // namespace quadrille::models::reference
