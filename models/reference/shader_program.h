/// A shader as flat code for four lanes: what the decoder makes of a SPIR-V module and the interpreter runs.
///
/// Every scalar of every value and variable has a *cell*: one number for each of the four lanes of a quad.
/// Instructions name cells by slot and carry the function that executes them, so running a shader allocates
/// and looks up nothing. Functions are inlined. Blocks are numbered so that lanes that took different ways
/// meet again when always the lowest-numbered waiting block runs next (`structured_order`).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "models/reference/sampling.h"

namespace quadrille::models::reference {

using Slot = std::uint32_t;
inline constexpr Slot kNoSlot = 0xffffffffu;
inline constexpr int kLanes = 4;  ///< pixels (0,0) (1,0) (0,1) (1,1) of a quad, or four vertices
inline constexpr unsigned kAllLanes = 0xf;

/// One scalar for each lane: the bits of a double, or a 32-bit integer or a bool (0, 1) in the low bits.
/// Which it is, the operation knows.
struct alignas(32) Cell {
  std::array<std::uint64_t, kLanes> bits{};

  [[nodiscard]] double f(int lane) const {
    return std::bit_cast<double>(bits[static_cast<std::size_t>(lane)]);
  }
  [[nodiscard]] std::uint32_t u(int lane) const {
    return static_cast<std::uint32_t>(bits[static_cast<std::size_t>(lane)]);
  }
  void set_f(int lane, double value) {
    bits[static_cast<std::size_t>(lane)] = std::bit_cast<std::uint64_t>(value);
  }
  void set_u(int lane, std::uint32_t value) { bits[static_cast<std::size_t>(lane)] = value; }
};

/// An instruction on a texture: what it asks, and the cells of its operands; `kNoSlot`: it has none of these.
struct TextureInstruction {
  enum class Kind : std::uint8_t { kSample, kFetch, kGather, kQueryLod };
  Kind kind = Kind::kSample;
  std::uint32_t texture = 0;
  Slot index = kNoSlot;  ///< cell with what is added to `texture`, which takes one of an array
  Slot coordinates = kNoSlot, reference = kNoSlot, bias = kNoSlot, level = kNoSlot, gradient_x = kNoSlot,
       gradient_y = kNoSlot, offsets = kNoSlot, sample = kNoSlot;
  bool projective = false;
  std::uint32_t coordinate_cells = 2;
  std::uint32_t component = 0;             ///< of a gather
  std::array<std::int32_t, 3> offset{};    ///< constant
  std::vector<std::int32_t> four_offsets;  ///< of a gather: eight numbers
};

/// The state of four lanes: their cells, who is running, who was discarded.
struct Lanes {
  std::vector<Cell> cells;
  unsigned mask = kAllLanes;  ///< lanes that execute now
  /// discarded; they go on as helpers, so that derivatives stay defined
  unsigned killed = 0;
  /// smallest |a - b| of a comparison that decided on a discard
  std::array<double, kLanes> discard_margin{};
  const std::vector<TextureView>* textures = nullptr;
  const std::vector<TextureInstruction>* instructions = nullptr;

  [[nodiscard]] Cell* at(Slot slot) { return cells.data() + slot; }
};

struct Operation;
using Handler = void (*)(const Operation&, Lanes&);

/// `run` computes `n` cells at `dst` from the cells at `src`. `step` is 0 where one scalar serves all
/// components, else 1. `imm` is the handler's own.
struct Operation {
  Handler run = nullptr;
  std::uint32_t n = 1;
  Slot dst = kNoSlot;
  std::array<Slot, 4> src{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
  std::array<std::uint8_t, 4> step{1, 1, 1, 1};
  std::array<std::uint32_t, 2> imm{};
};

/// A way out of a block: the code [first, first + count) moves phi values, then `target` runs.
struct Edge {
  std::uint32_t target = 0;
  std::uint32_t first = 0, count = 0;
  std::uint32_t literal = 0;  ///< kSwitch: taken if the selector equals it (edge 0: otherwise)
};

enum class BlockEnd : std::uint8_t { kJump, kBranch, kSwitch, kKill, kStop };

/// Straight code [first, first + count), then a way out: kJump and kKill edge 0; kBranch edge 0 where
/// `condition` is true, else edge 1.
struct Block {
  std::uint32_t first = 0, count = 0;
  BlockEnd end = BlockEnd::kStop;
  Slot condition = kNoSlot;
  std::uint32_t first_edge = 0, edges = 0;
};

enum class ScalarKind : std::uint8_t { kFloat, kInt, kBool };
enum class Interpolation : std::uint8_t { kPerspective, kLinear, kFlat };

/// A user-defined input or output scalar.
struct Port {
  std::uint32_t location = 0, component = 0;
  Slot slot = kNoSlot;
  ScalarKind kind = ScalarKind::kFloat;
  Interpolation interpolation = Interpolation::kPerspective;
  std::uint32_t index = 0;  ///< of a fragment shader's output: 1 is the second colour
  bool centroid = false;
};

/// A scalar of a uniform block or of the push constants (`push`), and where it goes.
struct UniformScalar {
  bool push = false;
  std::uint32_t set = 0, binding = 0, byte_offset = 0;
  Slot slot = kNoSlot;
  ScalarKind kind = ScalarKind::kFloat;
};

struct TextureUse {
  std::uint32_t set = 0, binding = 0;
  bool separate = false;  ///< its sampler is one of its own; all ones: it is used without
  std::uint32_t sampler_set = 0, sampler_binding = 0xffffffffu;
};

/// First slots of the built-in variables the shader has; `kNoSlot` for those it lacks.
struct BuiltinSlots {
  Slot position = kNoSlot, vertex_index = kNoSlot, instance_index = kNoSlot;
  Slot frag_coord = kNoSlot, front_facing = kNoSlot, primitive_id = kNoSlot, frag_depth = kNoSlot;
  Slot point_size = kNoSlot, point_coord = kNoSlot, sample_id = kNoSlot, sample_position = kNoSlot;
  Slot sample_mask_in = kNoSlot, sample_mask = kNoSlot;  ///< read, written
  Slot clip_distance = kNoSlot, cull_distance = kNoSlot;
  Slot viewport_index = kNoSlot;
  std::uint32_t clip_distances = 0, cull_distances = 0;  ///< as declared
};

struct ShaderProgram {
  std::string name;
  std::vector<Operation> code;
  std::vector<Block> blocks;
  std::vector<Edge> edges;
  std::vector<Cell> initial;  ///< all cells before the first instruction; constants have their values
  std::vector<Port> inputs, outputs;
  std::vector<UniformScalar> uniforms;
  std::vector<TextureUse> textures;
  std::vector<TextureInstruction> texture_instructions;
  BuiltinSlots builtins;
  bool early_fragment_tests = false;
  bool discards = false;
  bool by_sample = false;  ///< runs for each covered sample
};

/// Decodes a shader. Throws `UserError` naming the shader and what it uses that is outside the subset.
[[nodiscard]] ShaderProgram decode_shader(const traces::Shader& shader);

/// Runs the lanes of `start` from the first block to the end; `lanes.cells` holds the inputs before and the
/// outputs after. Throws `UserError` if a loop does not end.
void execute(const ShaderProgram& program, Lanes& lanes, unsigned start);

}  // namespace quadrille::models::reference
