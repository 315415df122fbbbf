/// Pictures of all directions: longitude from left to right, latitude from bottom to top.
#pragma once

#include <string>

#include "scenes/environment/radiance_cube.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {

/// Such a picture as a cube. Its middle shows +x, and longitude grows towards +z, as Khronos' viewer has it;
/// the upper edge is +y. Throws `UserError` that starts with `name` unless the picture is twice as wide as
/// high, has three or four channels, and its values are finite. Values below 0 count as 0.
[[nodiscard]] RadianceCube cube_of_panorama(FloatImage image, const std::string& name);

}  // namespace quadrille::scenes
