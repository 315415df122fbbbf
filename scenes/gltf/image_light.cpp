#include "scenes/gltf/image_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/environment/prefilter.h"
#include "scenes/gltf/nodes.h"
#include "scenes/gltf/value.h"
#include "scenes/image/mip_chain.h"

namespace quadrille::scenes {
namespace {

constexpr const char* kName = "EXT_lights_image_based";
constexpr std::uint64_t kMaxSide = 1024;

const tinygltf::Value& item(const tinygltf::Value& list, std::size_t i) {
  return list.Get(static_cast<int>(i));
}

/// A list of exactly `size` numbers.
template <std::size_t size>
std::array<double, size> numbers(const GltfObject& light, const tinygltf::Value& list,
                                 const std::string& member) {
  std::array<double, size> result{};
  if (!list.IsArray() || list.ArrayLen() != size) light.fail(member, fmt::format("{} numbers are due", size));
  for (std::size_t i = 0; i < size; ++i) {
    const tinygltf::Value& number = item(list, i);
    if (!number.IsNumber() || !std::isfinite(static_cast<float>(number.GetNumberAsDouble())))
      light.fail(member, fmt::format("{} finite numbers are due", size));
    result[i] = number.GetNumberAsDouble();
  }
  return result;
}

const tinygltf::Value& list_of(const GltfObject& light, const char* member) {
  static const tinygltf::Value kNone;
  const tinygltf::Value& list = light.has(member) ? light.value().Get(member) : kNone;
  if (!list.IsArray()) light.fail(member, "a list is due");
  return list;
}

glm::mat3 turn_of(const GltfObject& light) {
  if (!light.has("rotation")) return glm::mat3(1);
  const auto q = numbers<4>(light, light.value().Get("rotation"), "rotation");
  const glm::dquat turn(q[3], q[0], q[1], q[2]);
  const double length = std::sqrt(glm::dot(turn, turn));
  if (!(length > 1e-6) || !std::isfinite(length)) light.fail("rotation", "it is no quaternion of a rotation");
  return glm::mat3(glm::transpose(glm::mat3_cast(turn / length)));
}

/// The file's are of irradiance: of each harmonic, from which the normal's polynomials and the share of pi
/// follow. [P: Ramamoorthi and Hanrahan 2001]
std::array<glm::vec3, 9> irradiance_of(const GltfObject& light) {
  const double half = 0.5 * std::sqrt(std::numbers::inv_pi), first = std::sqrt(3.0) * half,
               second = std::sqrt(15.0) * half;
  const std::array<double, 9> constants{
      half, first, first, first, second, second, 0.5 * std::sqrt(5.0) * half, second, 0.5 * second};
  const tinygltf::Value& list = list_of(light, "irradianceCoefficients");
  if (list.ArrayLen() != 9) light.fail("irradianceCoefficients", "nine lists of three numbers are due");
  std::array<glm::vec3, 9> result{};
  for (std::size_t i = 0; i < 9; ++i) {
    const auto c = numbers<3>(light, item(list, i), fmt::format("irradianceCoefficients[{}]", i));
    result[i] = glm::vec3(glm::dvec3(c[0], c[1], c[2]) * (constants[i] * std::numbers::inv_pi));
  }
  return result;
}

/// Of PNG with alpha, RGB is divided by it; all are sRGB, as Babylon.js, which the extension comes from,
/// writes and reads them. Pictures are as they are seen from within: mirrored to how a machine has them.
void put_face(RadianceCube& cube, int face, const Rgba8Image& image) {
  for (std::uint32_t row = 0; row < cube.size; ++row) {
    for (std::uint32_t column = 0; column < cube.size; ++column) {
      const std::uint8_t* texel = &image.pixels[std::size_t{4} * (row * cube.size + cube.size - 1 - column)];
      const double divisor = std::max<int>(texel[3], 1) / 255.0;
      for (int i = 0; i < 3; ++i)
        cube.at(face, column, row)[i] = static_cast<float>(srgb_to_linear(texel[i] / 255.0) / divisor);
    }
  }
}

std::vector<RadianceCube> levels_of(const GltfFile& file, const GltfObject& light, ImageReader& images) {
  const std::uint64_t side = light.required_integer("specularImageSize");
  if (!std::has_single_bit(side) || side > kMaxSide)
    light.fail("specularImageSize", fmt::format("{} is not a power of two within 1..{}", side, kMaxSide));
  const tinygltf::Value& list = list_of(light, "specularImages");
  if (list.ArrayLen() == 0 || list.ArrayLen() > static_cast<std::size_t>(std::bit_width(side)))
    light.fail("specularImages",
               fmt::format("{} levels; legal are 1..{} where the first has {} texels a side", list.ArrayLen(),
                           std::bit_width(side), side));
  std::vector<RadianceCube> levels;
  for (std::size_t level = 0; level < list.ArrayLen(); ++level) {
    const std::string member = fmt::format("specularImages[{}]", level);
    const tinygltf::Value& faces = item(list, level);
    if (!faces.IsArray() || faces.ArrayLen() != 6) light.fail(member, "six images are due");
    RadianceCube cube(static_cast<std::uint32_t>(side >> level));
    for (int face = 0; face < 6; ++face) {
      const tinygltf::Value& number = item(faces, static_cast<std::size_t>(face));
      const int index = number.IsInt() ? number.Get<int>() : -1;
      if (index < 0 || static_cast<std::size_t>(index) >= file.model.images.size())
        light.fail(member,
                   fmt::format("face {} is not one of the file's {} images", face, file.model.images.size()));
      const SceneImage image = images.read(static_cast<std::size_t>(index));
      const Rgba8Image& pixels = image.pixels();
      if (pixels.width != cube.size || pixels.height != cube.size)
        light.fail(member, fmt::format("images[{}] has {}x{} pixels; {} a side are due", index, pixels.width,
                                       pixels.height, cube.size));
      put_face(cube, face, pixels);
    }
    levels.push_back(std::move(cube));
  }
  return levels;
}

}  // namespace

std::shared_ptr<const EnvironmentMap> read_image_light(const GltfFile& file, const std::string& choice,
                                                       ImageReader& images) {
  const std::optional<std::size_t> scene = scene_number(file, choice);
  if (!scene) return nullptr;
  const auto& extensions = file.model.scenes[*scene].extensions;
  const auto used = extensions.find(kName);
  if (used == extensions.end()) return nullptr;
  const GltfObject use(file.path, fmt::format("scenes[{}].{}", *scene, kName), used->second);
  const auto root = file.model.extensions.find(kName);
  static const tinygltf::Value kNone;
  const tinygltf::Value& table =
      root != file.model.extensions.end() && root->second.Has("lights") ? root->second.Get("lights") : kNone;
  const std::size_t count = table.IsArray() ? table.ArrayLen() : 0;
  const int index = use.index("light", count);
  const GltfObject light(file.path, fmt::format("extensions.{}.lights[{}]", kName, index),
                         item(table, static_cast<std::size_t>(index)));
  EnvironmentMap map;
  map.name = fmt::format("{} light {}", file.path, index);
  map.turn = turn_of(light);
  map.irradiance = irradiance_of(light);
  pack_levels(map, levels_of(file, light, images));
  const float intensity = light.number("intensity", 1, 0, 1e6);
  map.scale *= intensity;
  for (glm::vec3& coefficient : map.irradiance) coefficient *= intensity;
  return std::make_shared<const EnvironmentMap>(std::move(map));
}

}  // namespace quadrille::scenes
