/// How the clauses on a SIMD share its issue cycles when more could issue than it has cycles for, one file a
/// policy (simd_sharing_*.cpp).
#pragma once

#include "models/base/policy.h"

#include <cstdint>
#include <span>

namespace quadrille::hw {

/// A clause that issues on a SIMD.
struct SimdClause {
  std::uint32_t name = 0;
  double left = 0;   ///< cycles of its span
  double share = 0;  ///< of the SIMD that it can use
  double speed = 0;  ///< cycles of its span a cycle
};
/// Less than this of a cycle is rounding.
inline constexpr double kSimdRounding = 1e-6;

class SimdSharing {
 public:
  virtual ~SimdSharing() = default;
  /// Sets the speeds of the clauses, which stand in order of arrival: speed times share, summed, is at most
  /// one.
  virtual void share(std::span<SimdClause> clauses) = 0;
};

using SimdSharingPolicy = Policy<SimdSharing>;
/// What `core.scheduler` chooses from.
[[nodiscard]] PolicyList<SimdSharingPolicy>& simd_sharing_policies();
extern const SimdSharingPolicy kOldestSharing, kRoundRobinSharing;

}  // namespace quadrille::hw
