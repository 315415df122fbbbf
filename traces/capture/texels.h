/// Texels of a capture's image as the stream's.
///
/// The stream brings textures of four 8-bit components; formats with fewer or smaller components, and block
/// compressed ones, are expanded to these, and what a view says about components is done here.
/// (docs/deviations.md#D170)
#pragma once

#include <cstddef>
#include <vector>

#include "traces/capture/objects.h"

namespace quadrille::capture {

/// All levels of a layer of an image, finest first, as R8G8B8A8 of the view's kind (UNORM or SRGB). Levels
/// that the capture does not hold are zeros, and set `missing`.
[[nodiscard]] std::vector<std::byte> expanded_texels(const ImageObject& image, const ViewObject& view,
                                                     bool& missing);
/// Of the view's format. Throws `UserError` for one that cannot be expanded.
[[nodiscard]] traces::Format expanded_format(const ViewObject& view);

}  // namespace quadrille::capture
