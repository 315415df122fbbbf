/// Which pixels hang on an alpha next to its cut-off? The renderer is asked: it draws the frame again with
/// every cut-off moved by 1/255 up and down, and a pixel whose triangle then changes had an alpha within
/// 1/255 of the cut-off.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tests/lavapipe/vulkan_renderer.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// The stream of a scene with the cut-off of every material moved by `delta` (docs/shaders.md: the Material
/// block is set 1, binding 0, and the cut-off is the w of its second vector). Materials that do not test
/// alpha do not read it.
[[nodiscard]] traces::CommandStream with_cutoffs_moved(const traces::CommandStream& stream, float delta);

using Renderer = std::function<Rendered(const traces::CommandStream&)>;

/// One entry a pixel: 1 where moving the cut-offs of `triangles` by 1/255 changes what `base`, its picture by
/// the same renderer, shows.
[[nodiscard]] std::vector<std::uint8_t> alpha_ties(const traces::CommandStream& triangles,
                                                   const Rendered& base, const Renderer& render);

}  // namespace quadrille::lavapipe
