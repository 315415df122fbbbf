/// The tests of a sample against the depth attachment of its pass. Internal to the reference.
#pragma once

#include <cstddef>

#include "models/reference/coverage.h"
#include "models/reference/draw_state.h"
#include "models/reference/reference.h"

namespace quadrille::models::reference {

/// Of one draw. A place is a pixel's number times the samples of a pixel, and the sample's number.
class SampleTests {
 public:
  /// With `float_depth` depths are rounded to float32 before they are tested (mode *given*).
  SampleTests(const DrawState& state, bool float_depth, Result& result)
      : state_(state), float_depth_(float_depth), result_(result) {}

  /// What is added to a triangle's depths. [VK1.3 #primsrast-depthbias]
  [[nodiscard]] double bias_of(const WindowTriangle& triangle) const;
  /// A depth as it is tested: clamped where the pipeline says so, and as the attachment holds it. One that
  /// was moved by a bias ends at 0 and 1.
  [[nodiscard]] double final_depth(double z, bool biased, std::uint32_t viewport) const;
  /// Depth bounds, then stencil, then depth [VK1.3 #fragops]; writes what a sample leaves behind that passes
  /// or fails, and notes how near the decision of depth was.
  bool test_and_write(bool front, std::size_t place, double depth);

 private:
  [[nodiscard]] bool has_attachment() const { return state_.depth != nullptr; }
  bool test(bool front, std::size_t place, double depth);

  const DrawState& state_;
  bool float_depth_;
  Result& result_;
};

}  // namespace quadrille::models::reference
