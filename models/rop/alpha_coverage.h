/// Alpha to coverage: which samples of a pixel a fragment of some alpha keeps. [VK1.3 #fragops-covg]
#pragma once

#include <cstdint>

namespace quadrille::models {

/// Bit s: sample s of `count` is kept, which is where alpha > s / count; of a single one, where alpha > 1/2.
/// So more alpha never keeps fewer samples, 0 and NaN keep none, and 1 keeps all. Vulkan leaves the rule to
/// the implementation; this is lavapipe's.
[[nodiscard]] std::uint32_t alpha_coverage(float alpha, int count);

}  // namespace quadrille::models
