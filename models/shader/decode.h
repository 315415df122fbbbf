/// The form in which a program executes: one record an instruction, with the function that executes it chosen
/// once, for its operand kinds and modifiers.
///
/// Straight-line instructions run in *runs*: a run ends at control flow and where texture results must be
/// waited for. Both are known from the program text alone, because control flow always waits; so a run is a
/// plain loop over functions, and its cost a difference of two prefix sums.
#pragma once

#include "models/shader/warp.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::models {

/// What an executing instruction sees of its warp.
struct ExecutionContext {
  std::byte* regs = nullptr;  ///< RegisterRow by index
  const std::uint32_t* constants = nullptr;
  Warp* warp = nullptr;
  bool one_triangle = false;         ///< all quads have the same varyings
  alignas(64) LaneWords exec_lanes;  ///< all ones in lanes of `warp->exec`
};

/// A register row (byte offset into the register file) or a word of the constant file; the value read is
/// (bits & keep) ^ flip.
struct DecodedOperand {
  std::uint32_t offset = 0;
  std::uint32_t keep = ~0u, flip = 0;
};

struct alignas(64) DecodedInstruction {
  using Execute = void (*)(const DecodedInstruction&, ExecutionContext&);
  Execute all_lanes = nullptr;   ///< writes every lane: right when all launched lanes execute
  Execute some_lanes = nullptr;  ///< keeps lanes that do not execute
  DecodedOperand a, b, c;
  std::uint32_t dst = 0;  ///< byte offset of the first destination row
  std::uint16_t imm = 0;
  Op op = Op::kNop;
};

/// Where execution goes on. Instructions that `stop` are control flow or wait for textures; runs lie between
/// them.
struct Flow {
  std::uint32_t run_end = 0;    ///< a run that starts here ends before this instruction
  std::uint32_t target = 0;     ///< control: where to go when no lane is left
  std::uint8_t loop_frame = 0;  ///< kContinueIf: control depth of its loop
  bool stops = false, waits = false, control = false;
};

/// Instructions before a given one, by class.
struct IssueCounts {
  std::uint32_t alu = 0, sfu = 0, interp = 0, constant = 0, control = 0, exported = 0;
};

struct DecodedProgram;
/// Executes instructions [begin, end) of a straight run for the lanes of the context, which are all that were
/// launched (`all_lanes`) or not.
using RunExecutor = void (*)(const DecodedProgram& program, std::uint32_t begin, std::uint32_t end,
                             bool all_lanes, ExecutionContext& context);
/// Calls each instruction's kernel.
void interpret_run(const DecodedProgram& program, std::uint32_t begin, std::uint32_t end, bool all_lanes,
                   ExecutionContext& context);

struct DecodedProgram {
  RunExecutor execute_run = &interpret_run;  ///< another executor has to compute the same bits
  std::vector<DecodedInstruction> code;
  std::vector<Flow> flow;
  std::vector<IssueCounts> counts;  ///< code.size() + 1
  /// Output slots that some path through the program leaves unwritten, of those that are read behind it: all
  /// of a vertex program, and those of a fragment program that it writes at all. They begin with zeros.
  std::vector<std::uint16_t> partial_outputs;
};

/// Functions for one operation with given operand kinds.
struct Kernel {
  DecodedInstruction::Execute all_lanes = nullptr, some_lanes = nullptr;
};

/// What the choice of a kernel depends on.
struct KernelShape {
  unsigned constants = 0;  ///< bit i: operand i is a word of the constant file
  bool modified = false;   ///< some operand has a modifier
  bool saturate = false;
  unsigned sources = 0;
};

// Each answers an empty kernel for operations of the other files.
[[nodiscard]] Kernel float_kernel(Op op, const KernelShape& shape);
[[nodiscard]] Kernel special_kernel(Op op, const KernelShape& shape);
[[nodiscard]] Kernel integer_kernel(Op op, const KernelShape& shape);
[[nodiscard]] Kernel storage_kernel(Op op, const KernelShape& shape);
[[nodiscard]] Kernel interface_kernel(const Program& program, const Instruction& instruction,
                                      const KernelShape& shape);

/// The first instruction that breaks a rule of the ISA (docs/isa.md), and which rule.
struct ProgramFault {
  std::size_t instruction = 0;
  std::string what;
};
[[nodiscard]] std::optional<ProgramFault> program_fault(const Program& program);

/// Value of a constant word that is a literal, or nullptr.
[[nodiscard]] const std::uint32_t* literal_value(const ConstantLayout& layout, std::uint32_t word);

/// Runs of the program, jump targets and the places that wait for textures. The program has been checked.
[[nodiscard]] std::vector<Flow> analyse_flow(const Program& program);

}  // namespace quadrille::models
