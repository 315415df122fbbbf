/// The state of one lowering. Its parts are in lower_*.cpp: control flow, memory, storage buffers, interface
/// variables, arithmetic, matrices, images and GLSL.std.450.
#pragma once

#include "models/base/error.h"
#include "pipeline/compiler/builder.h"
#include "pipeline/compiler/ir.h"
#include "pipeline/compiler/spirv_module.h"

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace quadrille::pipeline {

using spirv::Id;
/// a value of any type, flattened to scalars: matrices by column, structs and arrays in order
using Values = std::vector<Value>;

/// What earlier attempts at lowering a shader found out.
struct Attempts {
  std::set<Id> looped_switches;  ///< left from inside a nested selection: lowered as loops that run once
  std::set<Id> rolled_loops;     ///< not worth or not capable of being unrolled
};
/// Thrown when an attempt must start again with one more header in a set.
struct StartAgain {
  std::set<Id> Attempts::*set;
  Id header;
};

class Lowering {
 public:
  Lowering(const spirv::Module& module, models::ShaderStage stage, const Attempts& attempts);
  ScalarShader run();

 private:
  // A place in memory. Offsets and strides are bytes in uniform blocks, scalars elsewhere.
  struct Index {
    Value value;
    std::uint32_t stride = 0, count = 0;
  };
  struct Pointer {
    spv::StorageClass storage = spv::StorageClassFunction;
    Id variable = 0, type = 0;
    std::uint32_t offset = 0, element_stride = 4, matrix_stride = 0;
    bool row_major = false;
    std::vector<Index> dynamic;
  };
  /// Where a scalar of an input or output variable goes.
  struct Slot {
    enum class Kind : std::uint8_t { kUsed, kRefused };
    Kind kind = Kind::kRefused;
    bool system = false;
    std::uint16_t imm = 0;
    models::Interpolation interpolation = models::Interpolation::kPerspective;
  };
  /// of a switch: label, mask of the lanes that enter there
  using Cases = std::vector<std::pair<Id, Value>>;
  /// Where a region of blocks ends.
  struct Stop {
    Id merge = 0;
    /// switch: cases still to come, with their flag variable
    const std::map<Id, Value>* falls_into = nullptr;
  };
  /// A LOOP of the ISA: a loop of the source, or a switch that is left from inside. Lanes that leave further
  /// than this loop set a flag, which is tested after it; `flags` names the places kept free for clearing the
  /// flags before the loop.
  struct LoopFrame {
    enum Leave : std::uint8_t { kBreak, kContinue, kKill, kLeaveCount };
    bool is_switch = false;
    bool unrolled = false, finished = false;  ///< lowered iteration by iteration; the last one has been met
    int nesting = 0;
    Id header = 0, merge = 0, continue_target = 0;
    std::size_t reserved = 0;  ///< first of kLeaveCount places in the code
    Value flags[kLeaveCount]{};
  };

  // lower.cpp
  const Values& value(Id id);
  Value scalar(Id id) { return value(id).at(0); }
  void define(const spirv::Instruction& i, Values values);
  void instruction(const spirv::Instruction& i);
  [[nodiscard]] UserError unsupported(const spirv::Instruction& i, std::string_view what) const;
  [[nodiscard]] Id value_type(Id id) const;
  [[nodiscard]] const spirv::Type& type_of(Id value) const { return module_.type(value_type(value)); }
  void check_size(const spirv::Instruction& i);

  // lower_control.cpp
  void region(Id first, const Stop& stop);
  Id lower_block(Id label, const Stop& stop);
  Id lower_loop(const spirv::Block& header, const Stop& stop);
  Id lower_unrolled(const spirv::Block& header, const Stop& stop);
  [[nodiscard]] bool may_unroll(Id header) const;
  void roll_a_loop() const;
  Id terminator(const spirv::Block& block, const Stop& stop);
  Id conditional(const spirv::Block& block, const Stop& stop);
  Id edge(Id from, Id to, const Stop& stop);
  Id follow(Id to, const Stop& stop);
  void side(Id from, Id to, const Stop& stop);
  void begin_block(const spirv::Block& block);
  void body(const spirv::Block& block);
  void copy_phis(Id from, Id to);
  void kill();
  void leave_if_killed();
  void leave(LoopFrame::Leave how);
  void push_loop(LoopFrame frame);
  void pop_loop();
  void conditional_exit(Value condition, Id from, Id to, const Stop& stop);
  [[nodiscard]] bool is_exit(Id to, const Stop& stop) const;
  [[nodiscard]] bool breaks_directly(Id to, Id& from) const;
  [[nodiscard]] LoopFrame* real_loop();
  [[nodiscard]] const LoopFrame* real_loop() const;

  // lower_selection.cpp
  Id selection(const spirv::Block& block, Value condition, Id yes, Id no, Id merge, const Stop& stop);
  Id lower_switch(const spirv::Block& block, const Stop& stop);
  [[nodiscard]] Id default_falls_into(const Cases& cases, Id otherwise, Id merge) const;
  void add_default(Cases& cases, Id otherwise, Value mask, Id merge) const;
  bool flatten(const spirv::Block& block, Value condition, Id yes, Id no);
  [[nodiscard]] int flat_cost(Id label, Id merge) const;
  [[nodiscard]] int flat_cost(const spirv::Instruction& i) const;

  // lower_memory.cpp
  void declare(const spirv::Variable& variable);
  void access_chain(const spirv::Instruction& i);
  void step(Pointer& p, Id index, const spirv::Instruction& i);
  void load(const spirv::Instruction& i);
  void store(const spirv::Instruction& i);
  void store_values(const Pointer& p, const Values& values, const spirv::Instruction& i);
  const Pointer& pointer(Id id, const spirv::Instruction& i) const;
  using WordVisitor = std::function<void(const Pointer&)>;
  void visit_words(const Pointer& p, const spirv::Instruction& i, const WordVisitor& visit) const;
  Value block_word(const Pointer& p, const spirv::Instruction& i);
  Values load_scalars(const Pointer& p, const spirv::Instruction& i);
  Value load_scalar(const Pointer& p, std::uint32_t place, const spirv::Instruction& i);
  std::uint32_t block_of(const Pointer& p);
  void find_tables();
  [[nodiscard]] std::vector<std::uint32_t> places(const Pointer& p, const spirv::Instruction& i) const;
  Value dynamic_offset(const Pointer& p, std::uint32_t unit);

  // lower_storage.cpp
  void declare_buffer(const spirv::Variable& variable);
  [[nodiscard]] std::uint16_t buffer_of(const Pointer& p, const spirv::Instruction& i) const;
  Value byte_offset(const Pointer& p, const spirv::Instruction& i);
  Value load_word(const Pointer& p, const spirv::Instruction& i);
  void store_words(const Pointer& p, const Values& values, const spirv::Instruction& i);
  bool storage(const spirv::Instruction& i);
  void atomic(const spirv::Instruction& i, models::Op op, Value operand, Value comparator = {});
  void array_length(const spirv::Instruction& i);

  // lower_interface.cpp
  void declare_interface(const spirv::Variable& variable);
  [[nodiscard]] bool follows_sample(const spirv::Variable& variable, const spirv::Decorations& d) const;
  void add_slots(std::vector<Slot>& slots, Id type, const spirv::Decorations& inherited,
                 std::uint32_t& location, bool output);
  Slot built_in_slot(std::int64_t built_in, std::uint32_t component, bool output) const;
  Slot location_slot(std::uint32_t location, std::uint32_t component, const spirv::Decorations& d,
                     bool output);
  Value load_input(Id variable, std::uint32_t place, const spirv::Instruction& i);
  void store_output(const Pointer& p, std::uint32_t place, Value v, const spirv::Instruction& i);

  // lower_arithmetic.cpp
  bool arithmetic(const spirv::Instruction& i);
  bool bit_operation(const spirv::Instruction& i);
  bool comparison(const spirv::Instruction& i);
  bool composite(const spirv::Instruction& i);
  void elementwise(const spirv::Instruction& i, models::Op op, bool swapped = false, bool inverted = false);
  std::uint32_t composite_offset(Id type, std::span<const std::uint32_t> indices, Id& found,
                                 const spirv::Instruction& i) const;
  Value dot(const Values& a, const Values& b);

  // lower_matrix.cpp
  bool matrix(const spirv::Instruction& i);
  void multiply(const spirv::Instruction& i);
  Value determinant(const Values& m, int size);
  Values inverse(const Values& m, int size);

  // lower_image.cpp
  bool image(const spirv::Instruction& i);
  void declare_texture(const spirv::Variable& variable);
  /// Of a scalar type of an interface or texture.
  [[nodiscard]] models::NumberKind number_kind(Id scalar) const;
  /// What an instruction says of an operation on a texture behind its coordinates.
  struct ImageOperands {
    Values bias, lod, gradients, offsets, sample;  ///< those that there are
    std::array<std::int8_t, 3> offset{};           ///< constant
    std::vector<std::uint32_t> four_offsets;       ///< of a gather: eight words
  };
  [[nodiscard]] std::uint16_t texture_of(Id image, const spirv::Instruction& i) const;
  [[nodiscard]] std::uint16_t texture_of_one_sample(Id image, const spirv::Instruction& i) const;
  [[nodiscard]] std::uint16_t texture_index(const models::TextureBinding& binding);
  void combine(const spirv::Instruction& i);
  [[nodiscard]] ImageOperands image_operands(const spirv::Instruction& i, std::size_t mask_at);
  [[nodiscard]] std::array<std::int8_t, 3> constant_offset(Id id, const spirv::Instruction& i) const;
  void sample(const spirv::Instruction& i);
  void fetch(const spirv::Instruction& i);
  void gather(const spirv::Instruction& i);
  void query_lod(const spirv::Instruction& i);
  void image_size(const spirv::Instruction& i);
  void levels_or_samples(const spirv::Instruction& i, std::uint16_t texture);
  /// Emits an operation: its four results.
  Values ask(const spirv::Instruction& i, const models::TextureOperation& operation, const Values& words);
  void derivative(const spirv::Instruction& i);

  // glsl450.cpp
  void glsl450(const spirv::Instruction& i);

  const spirv::Module& module_;
  ScalarShader shader_;
  ScalarBuilder build_{shader_};
  const Attempts& attempts_;
  std::unordered_map<Id, Values> values_;
  std::unordered_map<Id, Id> value_types_;
  std::unordered_map<Id, Pointer> pointers_;
  std::unordered_map<Id, const spirv::Variable*> variables_;
  /// function variables and shadowed outputs: one register a scalar
  std::unordered_map<Id, Values> memory_;
  std::unordered_map<Id, std::uint32_t> tables_;  ///< function variables that hold one constant: its block
  std::unordered_map<Id, std::vector<Slot>> slots_;
  std::unordered_set<Id> read_outputs_;
  std::unordered_map<Id, std::uint16_t> buffers_;   ///< variable -> storage buffer
  std::unordered_map<Id, std::uint16_t> textures_;  ///< variable or loaded value -> binding
  std::unordered_map<Id, std::pair<std::uint32_t, std::uint32_t>> samplers_;  ///< -> set and binding
  /// matrices that came as rows: loaded row-major, or a result of OpTranspose
  std::unordered_set<Id> transposed_;
  std::unordered_map<Id, Values> phis_, resolved_phis_;
  std::vector<LoopFrame> loops_;
  std::map<Id, Id> open_switches_;  ///< merge -> header of switches that are not loops
  Value killed_;                    ///< `Module::kills_return`: set for lanes that a demotion has killed
  int nesting_ = 0;
  std::size_t work_ = 0;
  std::pair<std::size_t, Id> widest_unrolled_;  ///< blocks, header
};

}  // namespace quadrille::pipeline
