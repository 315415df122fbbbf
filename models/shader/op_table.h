/// What each operation is: its mnemonic, its operands and what it occupies. One row an operation, in the
/// order of `Op`; the listing, the checker, the decoder and docs/isa.md follow this table.
#pragma once

#include "models/shader/isa.h"

namespace quadrille::models {

/// What the `imm` field of an operation names; it is written after the destination in a listing.
enum class Immediate : std::uint8_t {
  kUnused,
  kInputSlot,
  kVaryingSlot,
  kOutputSlot,
  kConstantWord,
  kTextureBinding,
  kTextureOperation,
  kBufferBinding
};

struct OpInfo {
  Op op;
  std::string_view name;
  IssueClass issue;
  std::uint8_t sources;       ///< operands read (0..3)
  std::uint8_t destinations;  ///< registers written
  std::uint8_t modifiable;    ///< bit i: operand i takes - and | |
  bool saturable;             ///< the result may be clamped to [0, 1]
  Immediate immediate = Immediate::kUnused;
};

[[nodiscard]] const OpInfo& op_info(Op op);

/// The operation with this mnemonic, or nullptr.
[[nodiscard]] const OpInfo* find_op(std::string_view name);

}  // namespace quadrille::models
