/// The decoder: SPIR-V module to `ShaderProgram`. Internal to the reference; split over decode_*.cpp by the
/// part of SPIR-V each reads.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "models/reference/shader_program.h"
#include "models/reference/spirv_module.h"

namespace quadrille::models::reference {

/// What an id stands for while decoding: cells holding a value, a place in memory (with a lane-varying
/// offset, perhaps), or a texture.
struct Value {
  enum class Kind : std::uint8_t { kNone, kCells, kPointer, kTexture, kSampler };
  Kind kind = Kind::kNone;
  Id type = 0;  ///< of the value, or of what is pointed to
  /// first cell; kTexture: index into `ShaderProgram::textures`; kSampler: its set, and `offset` its binding
  Slot slot = kNoSlot;
  /// pointer: cell with the offset in cells, different for each lane; none: `kNoSlot`
  Slot offset = kNoSlot;
  bool read_only = false;  ///< pointer: to inputs or uniforms, which a load may name instead of copying
  /// kTexture, kSampler: so many of an array from `slot` or `offset` on, and the cell with the number of the
  /// one that a lane takes; none: `kNoSlot`
  std::uint32_t count = 1;
  Slot index = kNoSlot;
};

class Decoder {
 public:
  explicit Decoder(const traces::Shader& shader);
  [[nodiscard]] ShaderProgram decode();

 private:
  /// A function while it is inlined.
  struct Frame {
    const SpirvFunction* function = nullptr;
    std::unordered_map<Id, Value> values;
    std::unordered_map<Id, std::uint32_t> labels;  // block label -> ours
    // comparisons, to find what decided on a discard
    std::unordered_map<Id, const SpirvInstruction*> definitions;
    // block that ends in a discard -> merge block of its construct
    std::unordered_map<Id, Id> kill_merge;
    std::uint32_t return_label = 0;
    Slot return_slot = kNoSlot;
    Frame* caller = nullptr;
    int depth = 0;
  };

  // decode_control.cpp: functions, blocks and edges.
  void inline_function(Frame& frame);
  void prepare_labels(Frame& frame, std::span<const std::size_t> order);
  void find_kill_merges(Frame& frame, std::span<const std::size_t> order);
  void call(Frame& frame, const SpirvInstruction& in);
  void terminate(Frame& frame, const SpirvBlock& block);
  void branch(Frame& frame, const SpirvBlock& block);
  void switch_block(Frame& frame, const SpirvBlock& block);
  void jump_to(std::uint32_t label, BlockEnd end);
  void record_discard_margin(Frame& frame, const SpirvInstruction& terminator);
  void margin_of(Frame& frame, Id condition);
  void phi_moves(Frame& frame, Id from, Id to);
  void end_block(BlockEnd end, Slot condition);
  void add_edge(Frame& frame, Id from, Id to, std::uint32_t literal);
  [[nodiscard]] std::uint32_t new_label();
  void begin_block(std::uint32_t label);
  void resolve_labels();

  // decode.cpp: module-level constants.
  void constant(const SpirvInstruction& in);
  void set_constant(const SpirvInstruction& in, Value& value);
  void specialised(const SpirvInstruction& in);

  // decode_interface.cpp: module-level variables.
  void variable(const SpirvInstruction& in);
  void interface_scalars(std::vector<Port>& ports, const Decorations& decorations, Id type, Slot slot,
                         std::uint32_t location, bool input);
  void builtin(std::uint32_t which, Slot slot, std::uint32_t cells, bool input);
  void block_scalars(UniformScalar place, Id type, const Decorations& layout);
  void uniform_variable(const SpirvInstruction& in, Value& value);
  void texture_variable(const SpirvInstruction& in, Value& value);

  // decode_memory.cpp: pointers and composites.
  [[nodiscard]] bool memory_instruction(Frame& frame, const SpirvInstruction& in);
  void local_variable(Frame& frame, const SpirvInstruction& in);
  void access_chain(Frame& frame, const SpirvInstruction& in);
  void choose_descriptor(Frame& frame, Value& descriptors, Id index);
  void step_into(Frame& frame, Value& pointer, Id index);
  void dynamic_step(Value& pointer, Slot index, std::uint32_t count, std::uint32_t stride);
  [[nodiscard]] Value load(const Value& pointer);
  void store(const Value& pointer, const Value& stored);
  [[nodiscard]] bool composite_instruction(Frame& frame, const SpirvInstruction& in);
  void construct(Frame& frame, const SpirvInstruction& in);
  void shuffle(Frame& frame, const SpirvInstruction& in);
  void insert(Frame& frame, const SpirvInstruction& in);
  [[nodiscard]] Value element(Value composite, std::span<const std::uint32_t> literals) const;

  // decode_instruction.cpp
  void instruction(Frame& frame, const SpirvInstruction& in);
  void arithmetic(Frame& frame, const SpirvInstruction& in, Handler handler,
                  std::span<const std::uint32_t> operands, bool n_from_result);
  [[nodiscard]] bool texture_instruction(Frame& frame, const SpirvInstruction& in);
  /// An instruction on a texture: its operands from word `mask_at` on are optional ones.
  void ask_texture(Frame& frame, const SpirvInstruction& in, TextureInstruction::Kind kind,
                   std::size_t mask_at);
  void image_operands(Frame& frame, const SpirvInstruction& in, std::size_t mask_at, TextureInstruction& ask);
  void combine(Frame& frame, const SpirvInstruction& in);
  void query(Frame& frame, const SpirvInstruction& in);

  // decode_glsl.cpp
  void glsl_instruction(Frame& frame, const SpirvInstruction& in);
  void two_results(Frame& frame, const SpirvInstruction& in, Handler handler);

  // Shared.
  [[nodiscard]] Slot allocate(std::uint32_t n);
  [[nodiscard]] Value new_value(Id type);
  /// a new value for the instruction's result
  [[nodiscard]] Value& define(Frame& frame, const SpirvInstruction& in);
  [[nodiscard]] const Value& value(const Frame& frame, Id id) const;
  [[nodiscard]] std::uint32_t cells(Id type) const { return module_.type(type).cells; }
  [[nodiscard]] std::uint32_t constant_word(Id id, std::string_view what) const;
  [[nodiscard]] bool is_constant(Id id) const { return constant_words_.contains(id); }
  Operation& emit(Handler handler, std::uint32_t n, Slot dst, std::initializer_list<Slot> sources);
  void copy(Slot dst, Slot src, std::uint32_t n);
  void zero(Slot dst, std::uint32_t n);
  void check_type(Id type) const;
  [[noreturn]] void unsupported(std::string_view what) const;
  [[noreturn]] void unsupported_op(std::uint32_t op) const;

  SpirvModule module_;
  traces::ShaderStage stage_;
  ShaderProgram program_;
  std::vector<Value> globals_;                            // by id
  std::unordered_map<Id, std::uint32_t> constant_words_;  // scalar integer constants
  std::vector<std::uint32_t> label_block_;                // label -> block
  std::vector<SpirvInstruction> initialised_;             // private and output variables to set on entry
  Slot zero_slot_ = kNoSlot;
};

}  // namespace quadrille::models::reference
