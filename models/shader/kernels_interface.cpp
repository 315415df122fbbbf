/// Operations that meet the world outside the warp: vertex inputs and system values, interpolation, outputs,
/// indexed constants, textures, discard.
#include "models/base/error.h"
#include "models/shader/kernels.h"

#include <algorithm>

namespace quadrille::models {
namespace {

using SysVal = SystemValue;

template <bool kMasked>
void copy_row(std::byte* dst, const void* row, const ExecutionContext& x) {
  for (int g = 0; g < kWarpGroups; ++g)
    write_group<kMasked>(dst, g, load_words(static_cast<const std::byte*>(row) + g * 32), x);
}

struct VertexAttribute {
  static const void* row(const DecodedInstruction& d, const Warp& warp) {
    return warp.vertex->attributes[d.imm].data();
  }
};
template <auto kMember>
struct VertexValue {
  static const void* row(const DecodedInstruction&, const Warp& warp) {
    return (warp.vertex->*kMember).data();
  }
};
template <auto kMember>
struct FragmentValue {
  static const void* row(const DecodedInstruction&, const Warp& warp) {
    return (warp.fragment->*kMember).data();
  }
};

template <class Input, bool kMasked>
void execute_input(const DecodedInstruction& d, ExecutionContext& x) {
  copy_row<kMasked>(x.regs + d.dst, Input::row(d, *x.warp), x);
}
template <class Input>
constexpr Kernel kInputKernel{&execute_input<Input, false>, &execute_input<Input, true>};

Kernel input_kernel(std::uint16_t slot) {
  if (slot < kFirstSystemValue) return kInputKernel<VertexAttribute>;
  switch (static_cast<SysVal>(slot)) {
    case SysVal::kVertexIndex: return kInputKernel<VertexValue<&VertexInputs::vertex_index>>;
    case SysVal::kInstanceIndex: return kInputKernel<VertexValue<&VertexInputs::instance_index>>;
    case SysVal::kFragCoordX: return kInputKernel<FragmentValue<&FragmentInputs::x>>;
    case SysVal::kFragCoordY: return kInputKernel<FragmentValue<&FragmentInputs::y>>;
    case SysVal::kFragCoordZ: return kInputKernel<FragmentValue<&FragmentInputs::z>>;
    case SysVal::kFragCoordW: return kInputKernel<FragmentValue<&FragmentInputs::inv_w>>;
    case SysVal::kFrontFacing: return kInputKernel<FragmentValue<&FragmentInputs::front_facing>>;
    case SysVal::kPrimitiveId: return kInputKernel<FragmentValue<&FragmentInputs::primitive_id>>;
    case SysVal::kPointCoordX: return kInputKernel<FragmentValue<&FragmentInputs::linear_1>>;
    case SysVal::kPointCoordY: return kInputKernel<FragmentValue<&FragmentInputs::linear_2>>;
    case SysVal::kSampleId: return kInputKernel<FragmentValue<&FragmentInputs::sample_id>>;
    case SysVal::kSamplePositionX: return kInputKernel<FragmentValue<&FragmentInputs::sample_x>>;
    case SysVal::kSamplePositionY: return kInputKernel<FragmentValue<&FragmentInputs::sample_y>>;
    case SysVal::kSampleMask: return kInputKernel<FragmentValue<&FragmentInputs::sample_mask>>;
  }
  return {};
}

/// One value of the plane of each of a group's two quads.
inline Floats quad_pair(const float* first, const float* second) {
  return {_mm256_set_m128(_mm_broadcast_ss(second), _mm_broadcast_ss(first))};
}

/// Weight of the second (`kSecond`) or third vertex, where a varying of this mode is taken.
template <Interpolation kMode, bool kSecond>
const LaneFloats& weight_of(const FragmentInputs& in) {
  switch (kMode) {
    case Interpolation::kPerspective: return kSecond ? in.persp_1 : in.persp_2;
    case Interpolation::kPerspectiveCentroid: return kSecond ? in.centroid_persp_1 : in.centroid_persp_2;
    case Interpolation::kLinearCentroid: return kSecond ? in.centroid_linear_1 : in.centroid_linear_2;
    case Interpolation::kLinear:
    case Interpolation::kFlat: break;
  }
  return kSecond ? in.linear_1 : in.linear_2;
}

/// (a0 + p1 (a1 - a0)) + p2 (a2 - a0), each step rounded; weights by the interpolation mode.
template <Interpolation kMode, bool kMasked>
void execute_interp(const DecodedInstruction& d, ExecutionContext& x) {
  const FragmentInputs& in = *x.warp->fragment;
  const auto& weight_1 = weight_of<kMode, true>(in);
  const auto& weight_2 = weight_of<kMode, false>(in);
  std::byte* const dst = x.regs + d.dst;
  const std::size_t first = 3u * d.imm;
  const auto finish = [&](int g, Floats a0, Floats da1, Floats da2) {
    if constexpr (kMode == Interpolation::kFlat) {
      write_group<kMasked>(dst, g, a0, x);
    } else {
      const Floats p1 = load_floats(weight_1.data() + g * kGroupLanes),
                   p2 = load_floats(weight_2.data() + g * kGroupLanes);
      write_group<kMasked>(
          dst, g, ordered_add(ordered_add(a0, ordered_multiply(p1, da1)), ordered_multiply(p2, da2)), x);
    }
  };
  if (x.one_triangle) {
    const float* plane = in.varyings[0] + first;
    const Floats a0 = splat(plane[0]), da1 = splat(plane[1]), da2 = splat(plane[2]);
    for (int g = 0; g < kWarpGroups; ++g) finish(g, a0, da1, da2);
    return;
  }
  for (int g = 0; g < kWarpGroups; ++g) {
    const float* left = in.varyings[static_cast<std::size_t>(2 * g)] + first;
    const float* right = in.varyings[static_cast<std::size_t>(2 * g + 1)] + first;
    finish(g, quad_pair(left, right), quad_pair(left + 1, right + 1), quad_pair(left + 2, right + 2));
  }
}
template <Interpolation kMode>
constexpr Kernel kInterpKernel{&execute_interp<kMode, false>, &execute_interp<kMode, true>};

Kernel interp_kernel(Interpolation mode) {
  switch (mode) {
    case Interpolation::kPerspective: return kInterpKernel<Interpolation::kPerspective>;
    case Interpolation::kLinear: return kInterpKernel<Interpolation::kLinear>;
    case Interpolation::kFlat: return kInterpKernel<Interpolation::kFlat>;
    case Interpolation::kPerspectiveCentroid: return kInterpKernel<Interpolation::kPerspectiveCentroid>;
    case Interpolation::kLinearCentroid: return kInterpKernel<Interpolation::kLinearCentroid>;
  }
  return {};
}

/// Reads an operand of either kind; for operations that are too rare for an instance each.
inline Lanes read_operand(const DecodedOperand& operand, bool constant, const ExecutionContext& x, int g) {
  const Words bits =
      constant ? splat_word(x.constants[operand.offset]) : load_words(x.regs + operand.offset + g * 32);
  return (bits & splat_word(operand.keep)) ^ splat_word(operand.flip);
}

/// Outputs belong to the caller, so only executing lanes are written, whatever the mask.
template <bool kConstant>
void execute_output(const DecodedInstruction& d, ExecutionContext& x) {
  LaneWords& row = x.warp->outputs[d.imm];
  for (int g = 0; g < kWarpGroups; ++g) {
    std::uint32_t* at = row.data() + g * kGroupLanes;
    store(at, choose(load_words(x.exec_lanes.data() + g * kGroupLanes), read_operand(d.a, kConstant, x, g),
                     load_words(at)));
  }
}

/// The index is signed and clamped to [0, b], so that no index leaves the constant file.
template <bool kConstant, bool kMasked>
void execute_load_const(const DecodedInstruction& d, ExecutionContext& x) {
  const Words last = splat_word(x.constants[d.b.offset]);
  const int* base = reinterpret_cast<const int*>(x.constants + d.imm);
  for (int g = 0; g < kWarpGroups; ++g) {
    const Words index = read_operand(d.a, kConstant, x, g);
    const __m256i clamped = _mm256_min_epi32(_mm256_max_epi32(index.v, _mm256_setzero_si256()), last.v);
    write_group<kMasked>(x.regs + d.dst, g, Words{_mm256_i32gather_epi32(base, clamped, 4)}, x);
  }
}

/// Records the request; all 32 lanes of the coordinates, so that differences within a quad exist whatever the
/// mask.
template <unsigned kConstants>
void execute_texture(const DecodedInstruction& d, ExecutionContext& x) {
  Warp& warp = *x.warp;
  TextureRequest& request = warp.textures[static_cast<std::size_t>(warp.texture_count++)];
  request.active = warp.exec;
  request.op = d.op;
  request.binding = d.imm;
  request.operation = nullptr;
  request.dst = static_cast<std::uint16_t>(d.dst / sizeof(RegisterRow));
  for (int g = 0; g < kWarpGroups; ++g) {
    store(request.u.data() + g * kGroupLanes, read_operand(d.a, (kConstants & 1u) != 0, x, g));
    store(request.v.data() + g * kGroupLanes, read_operand(d.b, (kConstants & 2u) != 0, x, g));
    store(request.lod.data() + g * kGroupLanes,
          d.op == Op::kTexImplicit ? Lanes(splat(0.0f)) : read_operand(d.c, (kConstants & 4u) != 0, x, g));
  }
}

/// The same for an operation that the program lists: three words an operand.
template <unsigned kConstants>
void execute_texture_operation(const DecodedInstruction& d, ExecutionContext& x) {
  Warp& warp = *x.warp;
  TextureRequest& request = warp.textures[static_cast<std::size_t>(warp.texture_count++)];
  request.active = warp.exec;
  request.op = d.op;
  request.operation = &warp.program->texture_operations[d.imm];
  request.binding = request.operation->texture;
  request.dst = static_cast<std::uint16_t>(d.dst / sizeof(RegisterRow));
  const DecodedOperand* const operands[] = {&d.a, &d.b, &d.c};
  for (unsigned word = 0; word < kMaxTextureWords; ++word) {
    const bool constant = (kConstants >> (word / 3) & 1u) != 0;
    DecodedOperand operand = *operands[word / 3];
    if (!constant) operand.offset += word % 3 * static_cast<std::uint32_t>(sizeof(RegisterRow));
    for (int g = 0; g < kWarpGroups; ++g)
      store(request.word(word).data() + g * kGroupLanes, read_operand(operand, constant, x, g));
  }
}

/// Three values side by side. All are read before one is written, since registers may be shared.
template <unsigned kConstants, bool kMasked>
void execute_pack(const DecodedInstruction& d, ExecutionContext& x) {
  for (int g = 0; g < kWarpGroups; ++g) {
    const Words a = read_operand(d.a, (kConstants & 1u) != 0, x, g),
                b = read_operand(d.b, (kConstants & 2u) != 0, x, g),
                c = read_operand(d.c, (kConstants & 4u) != 0, x, g);
    write_group<kMasked>(x.regs + d.dst, g, a, x);
    write_group<kMasked>(x.regs + d.dst + sizeof(RegisterRow), g, b, x);
    write_group<kMasked>(x.regs + d.dst + 2 * sizeof(RegisterRow), g, c, x);
  }
}

/// The level that eight lanes ask about, clamped to those that exist.
__m256i level_asked(const Words& wanted, const TextureSize& size) {
  const __m256i last = _mm256_min_epi32(splat_word(size.levels - 1).v, splat_word(31).v);
  return _mm256_min_epi32(_mm256_max_epi32(wanted.v, _mm256_setzero_si256()), last);
}
/// A side of that level.
Words side_of_level(std::uint32_t texels, __m256i level) {
  return {_mm256_max_epu32(_mm256_srlv_epi32(splat_word(texels).v, level), splat_word(1).v)};
}

/// Width and height of a level.
template <bool kConstant, bool kMasked>
void execute_texture_size(const DecodedInstruction& d, ExecutionContext& x) {
  const TextureSize& size = x.warp->texture_sizes[d.imm];
  for (int g = 0; g < kWarpGroups; ++g) {
    const __m256i level = level_asked(read_operand(d.a, kConstant, x, g), size);
    write_group<kMasked>(x.regs + d.dst, g, side_of_level(size.width, level), x);
    write_group<kMasked>(x.regs + d.dst + sizeof(RegisterRow), g, side_of_level(size.height, level), x);
  }
}

/// The same with its depth, or the layers, and the number of levels or samples.
template <bool kConstant, bool kMasked>
void execute_texture_dims(const DecodedInstruction& d, ExecutionContext& x) {
  const TextureSize& size = x.warp->texture_sizes[d.imm];
  for (int g = 0; g < kWarpGroups; ++g) {
    const __m256i level = level_asked(read_operand(d.a, kConstant, x, g), size);
    const Words third = size.layers != 0 ? splat_word(size.layers) : side_of_level(size.depth, level);
    const Words values[] = {side_of_level(size.width, level), side_of_level(size.height, level), third,
                            splat_word(size.samples != 0 ? size.samples : size.levels)};
    for (std::size_t k = 0; k < 4; ++k)
      write_group<kMasked>(x.regs + d.dst + k * sizeof(RegisterRow), g, values[k], x);
  }
}

/// Lanes that are discarded go on as helpers.
template <bool kConstant>
void execute_kill(const DecodedInstruction& d, ExecutionContext& x) {
  LaneMask met = 0;
  for (int g = 0; g < kWarpGroups; ++g)
    met |= nonzero_bits(read_operand(d.a, kConstant, x, g)) << (g * kGroupLanes);
  x.warp->killed |= met & x.warp->exec;
}

void execute_nothing(const DecodedInstruction&, ExecutionContext&) {}

template <unsigned... kConstants>
Kernel texture_kernel(unsigned constants, std::integer_sequence<unsigned, kConstants...>) {
  static constexpr DecodedInstruction::Execute kTable[] = {&execute_texture<kConstants>...};
  return {kTable[constants], kTable[constants]};
}
template <unsigned... kConstants>
Kernel texture_operation_kernel(unsigned constants, std::integer_sequence<unsigned, kConstants...>) {
  static constexpr DecodedInstruction::Execute kTable[] = {&execute_texture_operation<kConstants>...};
  return {kTable[constants], kTable[constants]};
}
template <unsigned... kConstants>
Kernel pack_kernel(unsigned constants, std::integer_sequence<unsigned, kConstants...>) {
  static constexpr Kernel kTable[] = {
      Kernel{&execute_pack<kConstants, false>, &execute_pack<kConstants, true>}...};
  return kTable[constants];
}

}  // namespace

Kernel interface_kernel(const Program& program, const Instruction& instruction, const KernelShape& shape) {
  const Op op = instruction.op;
  const bool constant = (shape.constants & 1u) != 0;
  const auto same = [](DecodedInstruction::Execute execute) { return Kernel{execute, execute}; };
  if (op == Op::kInput) return input_kernel(instruction.imm);
  if (op == Op::kInterp) return interp_kernel(program.varyings[instruction.imm]);
  if (op == Op::kOutput) return same(constant ? &execute_output<true> : &execute_output<false>);
  if (op == Op::kKillIf) return same(constant ? &execute_kill<true> : &execute_kill<false>);
  if (op == Op::kNop) return same(&execute_nothing);
  if (op == Op::kTexImplicit || op == Op::kTexBias || op == Op::kTexLod)
    return texture_kernel(shape.constants, std::make_integer_sequence<unsigned, 8>{});
  if (op == Op::kTexOp || op == Op::kTexOpQuad)
    return texture_operation_kernel(shape.constants, std::make_integer_sequence<unsigned, 8>{});
  if (op == Op::kPack) return pack_kernel(shape.constants, std::make_integer_sequence<unsigned, 8>{});
  if (op == Op::kTexDims)
    return constant ? Kernel{&execute_texture_dims<true, false>, &execute_texture_dims<true, true>}
                    : Kernel{&execute_texture_dims<false, false>, &execute_texture_dims<false, true>};
  if (op == Op::kLoadConst)
    return constant ? Kernel{&execute_load_const<true, false>, &execute_load_const<true, true>}
                    : Kernel{&execute_load_const<false, false>, &execute_load_const<false, true>};
  if (op == Op::kTexSize)
    return constant ? Kernel{&execute_texture_size<true, false>, &execute_texture_size<true, true>}
                    : Kernel{&execute_texture_size<false, false>, &execute_texture_size<false, true>};
  return {};
}

}  // namespace quadrille::models
