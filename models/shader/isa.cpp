/// The operation table.
#include "models/shader/isa.h"

#include "models/base/error.h"
#include "models/shader/op_table.h"

#include <algorithm>
#include <array>

namespace quadrille::models {
namespace {

constexpr IssueClass kAluOp = IssueClass::kAlu, kSfuOp = IssueClass::kSfu, kControlOp = IssueClass::kControl,
                     kTexOp = IssueClass::kTex, kStorageOp = IssueClass::kStorage;

constexpr OpInfo float_op(Op op, std::string_view name, int sources, IssueClass issue = kAluOp) {
  return {
      op,  name, issue, static_cast<std::uint8_t>(sources), 1, static_cast<std::uint8_t>((1 << sources) - 1),
      true};
}
constexpr OpInfo float_compare(Op op, std::string_view name) { return {op, name, kAluOp, 2, 1, 3, false}; }
constexpr OpInfo integer_op(Op op, std::string_view name, int sources, IssueClass issue = kAluOp) {
  return {op, name, issue, static_cast<std::uint8_t>(sources), 1, 0, false};
}
constexpr OpInfo control(Op op, std::string_view name, int sources) {
  return {op, name, kControlOp, static_cast<std::uint8_t>(sources), 0, 0, false};
}
constexpr OpInfo texture(Op op, std::string_view name, int sources) {
  return {op,     name,
          kTexOp, static_cast<std::uint8_t>(sources),
          4,      static_cast<std::uint8_t>((1 << sources) - 1),
          false,  Immediate::kTextureBinding};
}

constexpr OpInfo storage(Op op, std::string_view name, int sources, int destinations) {
  return {op,
          name,
          kStorageOp,
          static_cast<std::uint8_t>(sources),
          static_cast<std::uint8_t>(destinations),
          0,
          false,
          Immediate::kBufferBinding};
}

constexpr auto kOps = std::to_array<OpInfo>({
    {Op::kNop, "nop", kAluOp, 0, 0, 0, false},
    float_op(Op::kMov, "mov", 1),
    float_op(Op::kFAdd, "fadd", 2),
    float_op(Op::kFMul, "fmul", 2),
    float_op(Op::kFMad, "fmad", 3),
    float_op(Op::kFma, "ffma", 3),
    float_op(Op::kFMin, "fmin", 2),
    float_op(Op::kFMax, "fmax", 2),
    float_op(Op::kFFloor, "ffloor", 1),
    float_op(Op::kFCeil, "fceil", 1),
    float_op(Op::kFTrunc, "ftrunc", 1),
    float_op(Op::kFRoundEven, "froundeven", 1),
    float_op(Op::kFFract, "ffract", 1),
    float_op(Op::kFSign, "fsign", 1),
    float_op(Op::kFDiv, "fdiv", 2, kSfuOp),
    float_op(Op::kFRcp, "frcp", 1, kSfuOp),
    float_op(Op::kFRsq, "frsq", 1, kSfuOp),
    float_op(Op::kFSqrt, "fsqrt", 1, kSfuOp),
    float_op(Op::kFExp2, "fexp2", 1, kSfuOp),
    float_op(Op::kFLog2, "flog2", 1, kSfuOp),
    float_op(Op::kFSin, "fsin", 1, kSfuOp),
    float_op(Op::kFCos, "fcos", 1, kSfuOp),
    float_compare(Op::kFLt, "flt"),
    float_compare(Op::kFLe, "fle"),
    float_compare(Op::kFEq, "feq"),
    float_compare(Op::kFNe, "fne"),
    integer_op(Op::kIAdd, "iadd", 2),
    integer_op(Op::kISub, "isub", 2),
    integer_op(Op::kIMul, "imul", 2),
    integer_op(Op::kIDiv, "idiv", 2, kSfuOp),
    integer_op(Op::kIMod, "imod", 2, kSfuOp),
    integer_op(Op::kIRem, "irem", 2, kSfuOp),
    integer_op(Op::kUDiv, "udiv", 2, kSfuOp),
    integer_op(Op::kUMod, "umod", 2, kSfuOp),
    integer_op(Op::kIMin, "imin", 2),
    integer_op(Op::kIMax, "imax", 2),
    integer_op(Op::kUMin, "umin", 2),
    integer_op(Op::kUMax, "umax", 2),
    integer_op(Op::kIAbs, "iabs", 1),
    integer_op(Op::kISign, "isign", 1),
    integer_op(Op::kAnd, "and", 2),
    integer_op(Op::kOr, "or", 2),
    integer_op(Op::kXor, "xor", 2),
    integer_op(Op::kNot, "not", 1),
    integer_op(Op::kShl, "shl", 2),
    integer_op(Op::kShrU, "shru", 2),
    integer_op(Op::kShrS, "shrs", 2),
    integer_op(Op::kILt, "ilt", 2),
    integer_op(Op::kILe, "ile", 2),
    integer_op(Op::kIEq, "ieq", 2),
    integer_op(Op::kINe, "ine", 2),
    integer_op(Op::kULt, "ult", 2),
    integer_op(Op::kULe, "ule", 2),
    {Op::kF2I, "f2i", kAluOp, 1, 1, 1, false},
    {Op::kF2U, "f2u", kAluOp, 1, 1, 1, false},
    {Op::kI2F, "i2f", kAluOp, 1, 1, 0, true},
    {Op::kU2F, "u2f", kAluOp, 1, 1, 0, true},
    {Op::kSelect, "select", kAluOp, 3, 1, 6, true},
    float_op(Op::kDdxFine, "ddxfine", 1),
    float_op(Op::kDdyFine, "ddyfine", 1),
    float_op(Op::kDdxCoarse, "ddxcoarse", 1),
    float_op(Op::kDdyCoarse, "ddycoarse", 1),
    {Op::kInput, "input", kAluOp, 0, 1, 0, false, Immediate::kInputSlot},
    {Op::kInterp, "interp", IssueClass::kInterp, 0, 1, 0, false, Immediate::kVaryingSlot},
    {Op::kOutput, "output", IssueClass::kExport, 1, 0, 1, false, Immediate::kOutputSlot},
    {Op::kLoadConst, "loadconst", IssueClass::kConst, 2, 1, 0, false, Immediate::kConstantWord},
    texture(Op::kTexImplicit, "tex", 2),
    texture(Op::kTexBias, "texbias", 3),
    texture(Op::kTexLod, "texlod", 3),
    {Op::kTexSize, "texsize", IssueClass::kConst, 1, 2, 0, false, Immediate::kTextureBinding},
    {Op::kTexOp, "texop", kTexOp, 3, 4, 0, false, Immediate::kTextureOperation},
    {Op::kTexOpQuad, "texopquad", kTexOp, 3, 4, 0, false, Immediate::kTextureOperation},
    {Op::kTexDims, "texdims", IssueClass::kConst, 1, 4, 0, false, Immediate::kTextureBinding},
    {Op::kPack, "pack", kAluOp, 3, 3, 7, false},
    storage(Op::kLoadBuffer, "ldbuf", 1, 1),
    storage(Op::kStoreBuffer, "stbuf", 2, 0),
    storage(Op::kAtomicAdd, "atomadd", 2, 1),
    storage(Op::kAtomicIMin, "atomimin", 2, 1),
    storage(Op::kAtomicUMin, "atomumin", 2, 1),
    storage(Op::kAtomicIMax, "atomimax", 2, 1),
    storage(Op::kAtomicUMax, "atomumax", 2, 1),
    storage(Op::kAtomicAnd, "atomand", 2, 1),
    storage(Op::kAtomicOr, "atomor", 2, 1),
    storage(Op::kAtomicXor, "atomxor", 2, 1),
    storage(Op::kAtomicExchange, "atomxchg", 2, 1),
    storage(Op::kAtomicCompareExchange, "atomcas", 3, 1),
    {Op::kBufferSize, "bufsize", IssueClass::kConst, 0, 1, 0, false, Immediate::kBufferBinding},
    control(Op::kIf, "if", 1),
    control(Op::kElse, "else", 0),
    control(Op::kEndIf, "endif", 0),
    control(Op::kLoop, "loop", 0),
    control(Op::kBreakIf, "breakif", 1),
    control(Op::kContinueIf, "continueif", 1),
    control(Op::kContinuing, "continuing", 0),
    control(Op::kEndLoop, "endloop", 0),
    control(Op::kKillIf, "killif", 1),
    control(Op::kEnd, "end", 0),
});

constexpr bool in_enum_order() {
  for (std::size_t i = 0; i < kOps.size(); ++i)
    if (static_cast<std::size_t>(kOps[i].op) != i) return false;
  return kOps.size() == static_cast<std::size_t>(Op::kCount);
}
static_assert(in_enum_order(), "the table follows the order of Op");

}  // namespace

const OpInfo& op_info(Op op) {
  QUADRILLE_CHECK(op < Op::kCount, "operation number {}", static_cast<int>(op));
  return kOps[static_cast<std::size_t>(op)];
}

const OpInfo* find_op(std::string_view name) {
  const auto* found =
      std::find_if(kOps.begin(), kOps.end(), [&](const OpInfo& info) { return info.name == name; });
  return found == kOps.end() ? nullptr : found;
}

std::uint32_t color_outputs(const Program& program) {
  std::uint32_t outputs = 0;
  if (program.stage != ShaderStage::kFragment) return outputs;
  for (const Instruction& i : program.code) {
    if (i.op == Op::kOutput && i.imm < kMaxColorOutputs) outputs |= 1u << i.imm;
  }
  return outputs;
}

bool reads_coverage(const Program& program) {
  if (program.stage != ShaderStage::kFragment) return false;
  const auto centroid = [](Interpolation mode) {
    return mode == Interpolation::kPerspectiveCentroid || mode == Interpolation::kLinearCentroid;
  };
  const auto asks = [](const Instruction& i) {
    return i.op == Op::kInput && i.imm == static_cast<std::uint16_t>(SystemValue::kSampleMask);
  };
  return std::ranges::any_of(program.varyings, centroid) || std::ranges::any_of(program.code, asks);
}

TextureWords words_of(const TextureOperation& operation, ViewKind kind) {
  int next = coordinate_count(kind);
  TextureWords words;
  if (operation.compare) words.reference = next++;
  if (operation.level != LevelFrom::kQuad) words.level = next;
  if (operation.level == LevelFrom::kGradients) next += 2 * place_dimensions(kind);
  else if (operation.level != LevelFrom::kQuad) ++next;
  if (operation.offsets) words.offset = next;
  return words;
}
int word_count(const TextureOperation& operation, ViewKind kind) {
  const int level = operation.level == LevelFrom::kQuad        ? 0
                    : operation.level == LevelFrom::kGradients ? 2 * place_dimensions(kind)
                                                               : 1;
  return coordinate_count(kind) + (operation.compare ? 1 : 0) + level +
         (operation.offsets ? place_dimensions(kind) : 0);
}

bool is_atomic(Op op) { return op >= Op::kAtomicAdd && op <= Op::kAtomicCompareExchange; }
bool writes_buffer(Op op) { return op == Op::kStoreBuffer || is_atomic(op); }
bool writes_buffers(const Program& program) {
  return std::ranges::any_of(program.code, [](const Instruction& i) { return writes_buffer(i.op); });
}

const StageInfo& stage_info(ShaderStage stage) {
  static constexpr std::array<StageInfo, kStages> kInfos{
      {{"vertex", SystemValue::kVertexIndex, SystemValue::kInstanceIndex, true, false},
       {"fragment", SystemValue::kFragCoordX, SystemValue::kSampleMask, false, true}}};
  return kInfos[static_cast<std::size_t>(stage)];
}

std::string_view op_name(Op op) { return op_info(op).name; }
IssueClass issue_class(Op op) { return op_info(op).issue; }
int source_count(Op op) { return op_info(op).sources; }
int destination_count(Op op) { return op_info(op).destinations; }

}  // namespace quadrille::models
