/// Texels of a capture's image as the stream's.
///
/// They stay as they are, unless the view exchanges components: then they are bytes or floats in the order
/// that it shows. (docs/deviations.md#D170)
#pragma once

#include <cstddef>
#include <vector>

#include "traces/capture/objects.h"

namespace quadrille::capture {

/// All levels of a layer of an image, finest first, in `texture_format` of the view. Levels that the capture
/// does not hold are zeros, and set `missing`.
[[nodiscard]] std::vector<std::byte> texture_texels(const ImageObject& image, const ViewObject& view,
                                                    bool& missing);
/// Throws `UserError` for a view that the stream cannot bring texels for.
[[nodiscard]] traces::Format texture_format(const ViewObject& view);

}  // namespace quadrille::capture
