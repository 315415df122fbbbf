/// What an image is, and what a shader sees of it: lines, planes, volumes and cubes, arrays of them, and
/// planes of several samples a texel.
/// [VK1.3 #resources-images, #resources-image-views] Values are those of trace files and never change.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace quadrille::models {

enum class ImageKind : std::uint8_t { k1D, k2D, k3D };
enum class ViewKind : std::uint8_t {
  k2D,
  k1D,
  k3D,
  kCube,
  k1DArray,
  k2DArray,
  kCubeArray,
  k2DMultisampled,  ///< and the array: of several samples a texel, of which programs fetch one
  k2DMultisampledArray
};
inline constexpr ViewKind kLastViewKind = ViewKind::k2DMultisampledArray;
inline constexpr std::array<std::string_view, 9> kViewKindNames{
    "2d", "1d", "3d", "cube", "1d-array", "2d-array", "cube-array", "2d-ms", "2d-ms-array"};

[[nodiscard]] constexpr bool is_array(ViewKind kind) {
  return kind >= ViewKind::k1DArray && kind != ViewKind::k2DMultisampled;
}
[[nodiscard]] constexpr bool is_multisampled(ViewKind kind) { return kind >= ViewKind::k2DMultisampled; }
[[nodiscard]] constexpr bool is_cube(ViewKind kind) {
  return kind == ViewKind::kCube || kind == ViewKind::kCubeArray;
}
/// Coordinates that say where in the image, without the layer; of a cube, a direction.
[[nodiscard]] constexpr int place_dimensions(ViewKind kind) {
  switch (kind) {
    case ViewKind::k1D:
    case ViewKind::k1DArray: return 1;
    case ViewKind::k2D:
    case ViewKind::k2DArray:
    case ViewKind::k2DMultisampled:
    case ViewKind::k2DMultisampledArray: return 2;
    case ViewKind::k3D:
    case ViewKind::kCube:
    case ViewKind::kCubeArray: return 3;
  }
  return 2;
}
/// Coordinates with the layer.
[[nodiscard]] constexpr int coordinate_count(ViewKind kind) {
  return place_dimensions(kind) + (is_array(kind) ? 1 : 0);
}
/// The kind of an image that such a view can be of.
[[nodiscard]] constexpr ImageKind image_kind(ViewKind kind) {
  if (kind == ViewKind::k3D) return ImageKind::k3D;
  return place_dimensions(kind) == 1 ? ImageKind::k1D : ImageKind::k2D;
}
inline constexpr std::uint32_t kCubeFaces = 6;

/// What a view shows as a component: one of the texel's, or a number.
/// [VK1.3 #resources-image-views-identity-mappings]
enum class ComponentSource : std::uint8_t { kRed, kGreen, kBlue, kAlpha, kZero, kOne };
using ComponentMapping = std::array<ComponentSource, 4>;
inline constexpr ComponentMapping kSameComponents{ComponentSource::kRed, ComponentSource::kGreen,
                                                  ComponentSource::kBlue, ComponentSource::kAlpha};

}  // namespace quadrille::models
