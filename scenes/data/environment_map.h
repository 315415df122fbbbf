/// Light from all around, as a picture: what shaders sample of it, ready for the machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// A cube map whose levels are blurred ever more: a mirror of roughness r reflects level r * (levels - 1).
struct EnvironmentMap {
  std::string name;
  std::uint32_t size = 1, levels = 1;  ///< texels along a face of the finest level
  /// R16G16B16A16_SFLOAT, level by level, in each the faces +x -x +y -y +z -z as Vulkan has them
  std::vector<std::byte> texels;
  float scale = 1;  ///< radiance of a texel of one
  /// What a white diffuse surface of normal (x, y, z) shows: the sum of these times 1, y, z, x, xy, yz,
  /// 3zz - 1, xz, xx - yy. [P: Ramamoorthi and Hanrahan 2001]
  std::array<glm::vec3, 9> irradiance{};
  glm::mat3 turn{1};         ///< directions of the world to those of the map
  std::optional<Light> sun;  ///< too small for texels
  bool shown = false;        ///< as the background
};

}  // namespace quadrille::scenes
