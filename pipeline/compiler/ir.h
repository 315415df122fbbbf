/// The compiler's scalar code: the ISA's operations and structured control flow over any number of virtual
/// registers and named constant words.
///
/// A virtual register is defined once (SSA), except those marked `variable`: the targets of phi copies, local
/// arrays, read-back outputs.
#pragma once

#include "models/shader/isa.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace quadrille::pipeline {

struct Value {
  enum class Kind : std::uint8_t { kNone, kRegister, kLiteral, kUniform };
  Kind kind = Kind::kNone;
  std::uint8_t modifiers = 0;  ///< models::Operand::Modifier, for float operands
  std::uint32_t bits = 0;      ///< virtual register; the literal's bits; or constant block << 16 | word
  friend bool operator==(const Value&, const Value&) = default;
  [[nodiscard]] bool is_register() const { return kind == Kind::kRegister; }
  [[nodiscard]] bool is_literal() const { return kind == Kind::kLiteral; }
  [[nodiscard]] bool is_literal(std::uint32_t value) const { return kind == Kind::kLiteral && bits == value; }
};

/// As `models::Instruction`; a texture instruction defines `dst .. dst + destination_count - 1`.
/// kLoadConst: a = word index, b = largest index (literal), c = first word (uniform).
struct ScalarInstruction {
  models::Op op = models::Op::kNop;
  std::uint8_t flags = 0;
  std::uint16_t imm = 0;
  std::uint32_t dst = 0;
  Value a, b, c;
};

/// A uniform block, the push constants, or a table of literals that is indexed.
struct ConstantBlock {
  models::ConstantLayout::Source source = models::ConstantLayout::Source::kUniformBlock;
  std::uint32_t set = 0, binding = 0;
  std::vector<std::uint32_t> literals;
  friend bool operator==(const ConstantBlock&, const ConstantBlock&) = default;
};

inline constexpr std::uint32_t kNoRegister = 0xffffffffu;
inline constexpr std::uint32_t kMaxLocations = 64;  ///< varyings
/// vertex inputs: raw slots stay below the system values
inline constexpr std::uint32_t kMaxAttributeLocations = 32;

/// Raw output slots of a vertex shader beyond those of its varyings.
inline constexpr std::uint16_t kRawPointSize = models::kFirstVaryingOutput + 4 * kMaxLocations;
inline constexpr std::uint16_t kRawClipDistance = kRawPointSize + 1;
inline constexpr std::uint16_t kRawCullDistance = kRawClipDistance + models::kMaxUserDistances;
inline constexpr std::uint16_t kRawViewportIndex = kRawCullDistance + models::kMaxUserDistances;
inline constexpr std::uint16_t kRawOutputsEnd = kRawViewportIndex + 1;

/// One shader between lowering and emission. Slots are raw: kInput and kInterp name 4 * location + component
/// (or a system value), kOutput names the ISA's output slot, with varyings at kFirstVaryingOutput + 4 *
/// location + component, and the extra ones above. Linking packs them.
struct ScalarShader {
  models::ShaderStage stage = models::ShaderStage::kVertex;
  std::string name;
  std::vector<ScalarInstruction> code;
  std::vector<bool> variable;  ///< by virtual register
  std::vector<ConstantBlock> blocks;
  std::vector<models::TextureBinding> textures;
  std::vector<models::TextureOperation> texture_operations;
  std::vector<models::BufferBinding> buffers;               ///< storage buffers
  std::map<std::uint16_t, models::Interpolation> varyings;  ///< fragment: interpolation by raw slot
  /// vertex: bit i: input location i is of integers
  std::uint32_t integer_inputs = 0;
  bool early_fragment_tests = false;
  bool second_source = false;  ///< a second colour for attachment 0
  /// fragment: as `models::Program::color_kinds`
  std::array<models::NumberKind, models::kMaxColorAttachments> color_kinds{};
  bool by_sample = false;  ///< fragment: as `models::Program::by_sample`
};

}  // namespace quadrille::pipeline
