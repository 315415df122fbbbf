/// Called functions that discard, made fit to be expanded in place wherever they are called.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::pipeline {

/// A module whose calls can all be expanded.
struct ReturningKills {
  std::vector<std::uint32_t> words;
  /// some discards return: whoever runs on after a demotion must be taken out of loops
  /// (`Lowering::leave_if_killed`)
  bool any = false;
};

/// SPIR-V lets no block of a loop's continue construct end the invocation, so a function that discards cannot
/// be expanded there (in the condition of a do-while, say). In such functions, and in those that they call, a
/// discard becomes OpDemoteToHelperInvocation and a return of nothing in particular.
[[nodiscard]] ReturningKills let_kills_return(std::vector<std::uint32_t> words);

}  // namespace quadrille::pipeline
