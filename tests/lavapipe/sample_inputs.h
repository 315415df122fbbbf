/// Shading by sample, said in SPIR-V.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::lavapipe {

/// A fragment shader whose inputs by location, but flat ones, are decorated with Sample. Vulkan leaves open
/// where undecorated ones are taken when a pipeline asks for shading by sample; Quadrille takes them at the
/// sample, lavapipe at the pixel's centre.
[[nodiscard]] std::vector<std::uint32_t> with_sample_inputs(std::span<const std::uint32_t> spirv);

}  // namespace quadrille::lavapipe
