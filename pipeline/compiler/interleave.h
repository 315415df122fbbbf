/// Interleaving: while an instruction waits for its operands, independent ones issue.
///
/// Works on an order that is chosen already, in the straight-line pieces between control flow, discards and
/// the places where texture results are waited for. Clauses and groups of texture instructions stay as they
/// are.
#pragma once

#include "pipeline/compiler/ir.h"
#include "pipeline/compiler/liveness.h"
#include "pipeline/compiler/target.h"

namespace quadrille::pipeline {

/// Which instruction goes first, of those that can issue at the same time.
enum class Preference : std::uint8_t {
  kGivenOrder,   ///< the first in the given order: keeps few values alive
  kLongestChain  ///< the one with the most cycles of dependent work behind it
};

/// Reorders one program, again and again under other bounds. The program must outlive it.
class Interleaver {
 public:
  Interleaver(const std::vector<ScalarInstruction>& code, const std::vector<bool>& variable,
              const models::IssueTiming& timing)
      : code_(code), variable_(variable), timing_(timing), liveness_(code, variable.size()) {}
  /// An order that loses few issue cycles. Instructions are taken out of the given order only while at most
  /// `live` registers hold values.
  [[nodiscard]] std::vector<ScalarInstruction> run(Preference preference, std::size_t live) const;

 private:
  const std::vector<ScalarInstruction>& code_;
  const std::vector<bool>& variable_;
  const models::IssueTiming& timing_;
  Liveness liveness_;
};

/// Cycles that a warp with a SIMD to itself needs to issue the code, both sides of each selection and eight
/// turns of each loop. Waits for texels are not in it.
[[nodiscard]] double issue_cycles(const std::vector<ScalarInstruction>& code, std::size_t registers,
                                  const models::IssueTiming& timing);

}  // namespace quadrille::pipeline
