/// One renderer for all test cases of a process.
#pragma once

#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {

/// The renderer, or nothing after a warning that says why the test is skipped.
[[nodiscard]] VulkanRenderer* renderer();

}  // namespace quadrille::lavapipe
