/// The register ISA of the shader cores: scalar 32-bit operations over a warp of 32 lanes.
///
/// A program is a flat list of instructions. Each lane owns `num_regs` 32-bit registers (a float or an
/// integer: the operation decides). An operand is a register or a word of the *constant file*: one array of
/// 32-bit words a draw, the same for all lanes, that holds literals, push constants and uniform blocks
/// (`ConstantLayout` says where each word comes from). Control flow is structured, so divergence is a stack
/// of lane masks. docs/isa.md is the reference; `disassemble` prints a listing and `assemble` reads it back.
#pragma once

#include "models/base/attachment.h"
#include "models/base/format.h"
#include "models/base/image_view.h"
#include "models/base/pipeline_state.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::models {

inline constexpr int kWarpLanes = 32;
inline constexpr int kWarpQuads = 8;
inline constexpr int kQuadPixels = 4;
inline constexpr int kMaxRegisters = 256;
inline constexpr int kMaxVaryings = 64;      ///< scalar components between vertex and fragment shader
inline constexpr int kMaxVertexInputs = 64;  ///< scalar components (16 attributes of 4)
inline constexpr int kMaxUserDistances = 8;  ///< clip and cull distances of a vertex, together
inline constexpr int kMaxColorOutputs = 4 * kMaxColorAttachments;  ///< scalar components

/// Operations. `f` marks float operands, `i` signed and `u` unsigned integers; comparisons write all ones
/// (true) or zero.
// clang-format off: operations stay grouped by kind
enum class Op : std::uint8_t {
  kNop,
  kMov,
  // Float, full rate. FMAD rounds twice (product, then sum), so fusing a multiply and an add never changes a
  // value; FMA rounds once.
  kFAdd,
  kFMul,
  kFMad,
  kFma,
  kFMin,
  kFMax,
  kFFloor,
  kFCeil,
  kFTrunc,
  kFRoundEven,
  kFFract,
  kFSign,
  // Float, special-function rate.
  kFDiv,
  kFRcp,
  kFRsq,
  kFSqrt,
  kFExp2,
  kFLog2,
  kFSin,
  kFCos,
  // Float comparisons: ordered ones are false on NaN; kFNe is unordered (true on NaN).
  kFLt,
  kFLe,
  kFEq,
  kFNe,
  // Integer.
  kIAdd,
  kISub,
  kIMul,
  kIDiv,
  kIMod,
  kIRem,
  kUDiv,
  kUMod,
  kIMin,
  kIMax,
  kUMin,
  kUMax,
  kIAbs,
  kISign,
  kAnd,
  kOr,
  kXor,
  kNot,
  kShl,
  kShrU,
  kShrS,
  kILt,
  kILe,
  kIEq,
  kINe,
  kULt,
  kULe,
  // Conversions (float to integer truncates and saturates; NaN gives 0).
  kF2I,
  kF2U,
  kI2F,
  kU2F,
  // dst = a ? b : c, bitwise test of a != 0.
  kSelect,
  // Screen-space derivatives within the quad; lanes of a quad are (0,0) (1,0) (0,1) (1,1). "Fine" uses the
  // lane's own row/column, "coarse" the first.
  kDdxFine,
  kDdyFine,
  kDdxCoarse,
  kDdyCoarse,
  // Inputs and outputs; `imm` is the slot (see Program).
  /// vertex stage: dst = vertex input component or system value `imm`; fragment stage: dst = system value
  /// `imm`
  kInput,
  kInterp,     ///< fragment stage: dst = varying component `imm`, by its interpolation mode
  kOutput,     ///< output slot `imm` = a
  kLoadConst,  ///< dst = constant word [imm + (lane's a)], a clamped to [0, b]; b is a literal constant
  // Texturing: a = u, b = v, c = bias or explicit level of detail (if any), `imm` = texture binding; writes
  // dst .. dst+3 (rgba).
  kTexImplicit,
  kTexBias,
  kTexLod,
  kTexSize,  ///< dst, dst+1 = width, height (integers) of texture `imm` at level a
  // All other operations on textures: `imm` = operation (`TextureOperation`). Its words come three to an
  // operand: a register stands for itself and the two behind it; a constant for three times itself.
  kTexOp,
  kTexOpQuad,  ///< one that takes differences within the quad
  /// dst .. dst+3 = width, height, depth or layers, and levels of texture `imm`, at level a; samples in place
  /// of levels where a texel has several
  kTexDims,
  kPack,  ///< dst, dst+1, dst+2 = a, b, c
  // Storage buffers: a = byte offset, a multiple of 4; `imm` = buffer binding. Atomic operations write what
  // the word was to dst.
  kLoadBuffer,   ///< dst = the word
  kStoreBuffer,  ///< the word = b
  kAtomicAdd,    ///< the word = word + b; and so on
  kAtomicIMin,
  kAtomicUMin,
  kAtomicIMax,
  kAtomicUMax,
  kAtomicAnd,
  kAtomicOr,
  kAtomicXor,
  kAtomicExchange,
  kAtomicCompareExchange,  ///< the word = b where it equals c
  kBufferSize,             ///< dst = bytes of the buffer
  // Control. IF pushes the mask and keeps lanes with a != 0.
  // LOOP repeats until no lane is left; lanes that break rejoin after ENDLOOP, lanes that continue rejoin at
  // CONTINUING (a loop may have one, directly in its body: the continue block of SPIR-V follows it) or else
  // at ENDLOOP.
  kIf,
  kElse,
  kEndIf,
  kLoop,
  kBreakIf,
  kContinueIf,
  kContinuing,
  kEndLoop,
  kKillIf,  ///< discards lanes with a != 0; they go on as helpers
  kEnd,
  kCount
};
// clang-format on

/// What an instruction occupies while it issues; decides its cycles.
enum class IssueClass : std::uint8_t { kAlu, kSfu, kInterp, kConst, kTex, kControl, kExport, kStorage };

struct Operand {
  enum Kind : std::uint8_t { kNone, kRegister, kConstant };
  enum Modifier : std::uint8_t { kNegate = 1, kAbsolute = 2 };  ///< float operands only; |a| applies before -
  Kind kind = kNone;
  std::uint8_t modifiers = 0;
  std::uint16_t index = 0;
  friend bool operator==(const Operand&, const Operand&) = default;
};

struct Instruction {
  enum Flag : std::uint8_t { kSaturate = 1 };  ///< clamps a float result to [0, 1], NaN to 0
  Op op = Op::kNop;
  std::uint8_t flags = 0;
  std::uint16_t dst = 0;
  std::uint16_t imm = 0;
  Operand a{}, b{}, c{};
  friend bool operator==(const Instruction&, const Instruction&) = default;
};

/// System values that `kInput` can name: slots from `kFirstSystemValue` on.
inline constexpr std::uint16_t kFirstSystemValue = 128;
enum class SystemValue : std::uint16_t {
  kVertexIndex = kFirstSystemValue,
  kInstanceIndex,
  kFragCoordX,
  kFragCoordY,
  kFragCoordZ,
  kFragCoordW,
  kFrontFacing,
  kPrimitiveId,
  kPointCoordX,
  kPointCoordY,
  kSampleId,
  kSamplePositionX,  ///< in the pixel, from its upper left corner
  kSamplePositionY,
  kSampleMask  ///< samples that the primitive covers, a bit each; of one alone where its fragment is shaded
};

/// Output slots. Vertex stage: 0..3 clip-space position, then varyings from 4, then what `VertexExtras` says.
/// Fragment stage: 4 to each of eight colour attachments, then depth and the mask of samples.
inline constexpr std::uint16_t kFirstVaryingOutput = 4;
inline constexpr std::uint16_t kDepthOutput = kMaxColorOutputs, kSampleMaskOutput = kDepthOutput + 1;
inline constexpr int kFragmentOutputs = kSampleMaskOutput + 1;
/// The second colour for attachment 0, of a program that has one: it takes the place of attachment 1's.
inline constexpr std::uint16_t kSecondSourceOutput = 4;

/// Of a centroid varying the place is a covered sample where the primitive does not cover all of them.
enum class Interpolation : std::uint8_t {
  kPerspective,
  kLinear,
  kFlat,
  kPerspectiveCentroid,
  kLinearCentroid
};

/// Where words of the constant file come from. Literals carry their value; blocks are copied from a buffer
/// when a draw is bound.
struct ConstantLayout {
  enum class Source : std::uint8_t { kLiteral, kPushConstant, kUniformBlock };
  struct Range {
    Source source = Source::kLiteral;
    std::uint32_t set = 0, binding = 0;  ///< uniform block
    std::uint32_t byte_offset = 0;       ///< within the block or the push constants
    std::uint32_t first_word = 0;        ///< in the constant file
    std::uint32_t words = 0;
    std::vector<std::uint32_t> literals;  ///< kLiteral: the values
    friend bool operator==(const Range&, const Range&) = default;
  };
  std::vector<Range> ranges;
  std::uint32_t words = 0;  ///< size of the constant file
  friend bool operator==(const ConstantLayout&, const ConstantLayout&) = default;
};

/// What a vertex program writes for the fixed functions behind it: slots behind its varyings, in this order.
struct VertexExtras {
  bool point_size = false;
  std::uint8_t clip_distances = 0, cull_distances = 0;  ///< together at most 8
  bool viewport_index = false;
  [[nodiscard]] int count() const {
    return (point_size ? 1 : 0) + clip_distances + cull_distances + (viewport_index ? 1 : 0);
  }
  friend bool operator==(const VertexExtras&, const VertexExtras&) = default;
};

/// `TextureBinding::sampler_binding` of a texture that brings its sampler, and of one that is used without.
inline constexpr std::uint32_t kCombined = 0xffffffffu, kNoSampler = 0xfffffffeu;

struct TextureBinding {
  std::uint32_t set = 0, binding = 0;
  NumberKind texels = NumberKind::kFloat;  ///< what the program takes them for
  ViewKind view = ViewKind::k2D;
  std::uint32_t sampler_set = 0, sampler_binding = kCombined;  ///< of a sampler of its own
  friend bool operator==(const TextureBinding&, const TextureBinding&) = default;
};

/// What a kTexOp does with its texture.
enum class TextureAsk : std::uint8_t {
  kSample,    ///< the filtered texel
  kFetch,     ///< a texel by its integer coordinates and level, or sample
  kGather,    ///< a component of the four texels that a linear filter would take
  kQueryLod,  ///< x: the level that would be read; y: the level of detail before it is limited to the levels
};
/// Where its level of detail comes from.
enum class LevelFrom : std::uint8_t {
  kQuad,      ///< differences within the quad
  kBias,      ///< the same, and a bias
  kLevel,     ///< given; of a fetch, an integer, which of a multisampled view is the sample
  kGradients  ///< derivatives of the coordinates along x, then along y
};
inline constexpr int kMaxTextureWords = 9;

/// An operation on a texture. Its words are, in this order: coordinates, with the layer last; the reference
/// to compare with; bias, level, or gradients; offsets.
struct TextureOperation {
  std::uint16_t texture = 0;  ///< index into `Program::textures`
  TextureAsk ask = TextureAsk::kSample;
  LevelFrom level = LevelFrom::kLevel;
  bool compare = false;                 ///< a reference with each texel, by the sampler's comparison
  bool offsets = false;                 ///< has words with offsets
  std::uint8_t component = 0;           ///< that a gather takes
  std::array<std::int8_t, 3> offset{};  ///< in texels, added to the coordinates; besides those of words
  friend bool operator==(const TextureOperation&, const TextureOperation&) = default;
};
/// Words of an operation on a texture of this kind.
[[nodiscard]] int word_count(const TextureOperation& operation, ViewKind kind);
/// Places of the words behind the coordinates; -1: it has none of these.
struct TextureWords {
  int reference = -1, level = -1, offset = -1;
};
[[nodiscard]] TextureWords words_of(const TextureOperation& operation, ViewKind kind);

/// A storage buffer.
struct BufferBinding {
  std::uint32_t set = 0, binding = 0;
  friend bool operator==(const BufferBinding&, const BufferBinding&) = default;
};

struct VertexInputUse {
  std::uint16_t location = 0, component = 0;  ///< slot i of `Program::vertex_inputs` feeds kInput imm == i
  friend bool operator==(const VertexInputUse&, const VertexInputUse&) = default;
};

inline constexpr std::size_t kStages = 2;

/// What a stage of the pipeline gives to its programs; a row a stage, in the order of `ShaderStage`.
struct StageInfo {
  std::string_view name;
  SystemValue first_system_value, last_system_value;
  bool fetches;  ///< has vertex inputs
  bool quads;    ///< runs quads of pixels: varyings, derivatives, implicit levels of detail, discards
};
[[nodiscard]] const StageInfo& stage_info(ShaderStage stage);

/// The form in which a program executes (models/shader/decode.h). A program holds it once it has been
/// prepared; a copy of a program starts without.
struct DecodedProgram;
class DecodedCache {
 public:
  DecodedCache() = default;
  DecodedCache(const DecodedCache&) {}
  DecodedCache(DecodedCache&&) = default;
  DecodedCache& operator=(const DecodedCache&) {
    form_.reset();
    return *this;
  }
  DecodedCache& operator=(DecodedCache&&) = default;
  ~DecodedCache() = default;
  [[nodiscard]] const DecodedProgram* get() const { return form_.get(); }
  void set(std::shared_ptr<const DecodedProgram> form) { form_ = std::move(form); }
  /// never part of a program's value
  friend bool operator==(const DecodedCache&, const DecodedCache&) { return true; }

 private:
  std::shared_ptr<const DecodedProgram> form_;
};

struct Program {
  ShaderStage stage = ShaderStage::kVertex;
  std::string name;               ///< for listings and errors
  std::vector<Instruction> code;  ///< ends with kEnd
  int num_regs = 0;
  ConstantLayout constants;
  std::vector<TextureBinding> textures;              ///< kTex* imm indexes this
  std::vector<TextureOperation> texture_operations;  ///< imm of kTexOp indexes this
  std::vector<BufferBinding> buffers;                ///< imm of storage operations indexes this
  std::vector<VertexInputUse> vertex_inputs;         ///< vertex stage
  /// both stages of a pipeline hold the same list: scalar components, packed
  std::vector<Interpolation> varyings;
  VertexExtras extras;  ///< vertex stage
  bool uses_discard = false;
  bool writes_depth = false;
  bool writes_sample_mask = false;
  bool by_sample = false;  ///< runs for each covered sample: it asks which, or has inputs that follow it
  bool early_fragment_tests = false;
  bool second_source = false;  ///< of attachment 0, at `kSecondSourceOutput`
  /// What it writes to each location, as it declares it.
  std::array<NumberKind, kMaxColorAttachments> color_kinds{};
  bool uses_derivatives = false;  ///< explicit or through implicit-lod texturing: helper lanes are needed
  /// What an atomic operation returned reaches its outputs or discards: they depend on the order of warps.
  bool outputs_follow_atomics = false;
  mutable DecodedCache decoded;  ///< filled by `prepare`
  friend bool operator==(const Program&, const Program&) = default;
};

/// Checks a program (registers, slots, constants, structure of its control flow) and decodes it for
/// execution; `Warp::launch` does so by itself the first time. Call it again after changing `code` of a
/// program that has run. Throws `UserError` naming the program and the instruction.
void prepare(const Program& program);

/// Of a vertex program: the slot of its first extra output, and how many outputs there are.
[[nodiscard]] inline int first_extra_output(const Program& program) {
  return kFirstVaryingOutput + static_cast<int>(program.varyings.size());
}
[[nodiscard]] inline int vertex_outputs(const Program& program) {
  return first_extra_output(program) + program.extras.count();
}

/// Does a fragment program ask which samples the primitive covers, itself or by a centroid varying?
[[nodiscard]] bool reads_coverage(const Program& program);

/// Components of colours that a fragment program writes: bit 4 * attachment + component.
[[nodiscard]] std::uint32_t color_outputs(const Program& program);

[[nodiscard]] bool is_atomic(Op op);
/// Does the operation write a word of a storage buffer?
[[nodiscard]] bool writes_buffer(Op op);
/// Does some instruction of the program?
[[nodiscard]] bool writes_buffers(const Program& program);

[[nodiscard]] std::string_view op_name(Op op);
[[nodiscard]] IssueClass issue_class(Op op);
/// Number of source operands the operation reads (0..3).
[[nodiscard]] int source_count(Op op);
/// Number of consecutive registers written from `dst` (0 to 4).
[[nodiscard]] int destination_count(Op op);
/// Registers that each register operand stands for.
[[nodiscard]] constexpr int operand_width(Op op) { return op == Op::kTexOp || op == Op::kTexOpQuad ? 3 : 1; }
/// Is it a request to the texture unit?
[[nodiscard]] constexpr bool is_texture_request(Op op) {
  return (op >= Op::kTexImplicit && op <= Op::kTexLod) || op == Op::kTexOp || op == Op::kTexOpQuad;
}
/// Does it take its level of detail from differences within the quad?
[[nodiscard]] constexpr bool takes_level_from_quad(Op op) {
  return op == Op::kTexImplicit || op == Op::kTexBias || op == Op::kTexOpQuad;
}

/// One line an instruction; constants that are literals are printed with their value. `assemble` gives the
/// same program back, provided that fields an instruction does not use are zero.
[[nodiscard]] std::string disassemble(const Program& program);
/// Reads a listing. Throws `UserError` with the line on a mistake.
[[nodiscard]] Program assemble(std::string_view text, std::string_view name);

}  // namespace quadrille::models
