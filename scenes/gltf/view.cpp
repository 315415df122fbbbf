#include "scenes/gltf/view.h"

#include <cmath>

#include <fmt/format.h>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

[[noreturn]] void fail(const GltfFile& file, const std::string& place, const std::string& reason) {
  throw user_error("{}: {}: {}", file.path, place, reason);
}

void read_perspective(const GltfFile& file, const tinygltf::PerspectiveCamera& source,
                      const std::string& place, Camera& camera) {
  if (!(source.yfov > 0) || !std::isfinite(source.yfov))
    fail(file, place, fmt::format("yfov {} is not positive", source.yfov));
  if (!(source.znear > 0) || !std::isfinite(source.znear))
    fail(file, place, fmt::format("znear {} is not positive", source.znear));
  if (source.zfar != 0 && !(source.zfar > source.znear))
    fail(file, place, fmt::format("zfar {} is not beyond znear {}", source.zfar, source.znear));
  camera.yfov = source.yfov;
  camera.near = source.znear;
  // tinygltf has 0 for a missing one: infinite
  camera.far = source.zfar == 0 ? std::nullopt : std::optional<double>(source.zfar);
}

void read_orthographic(const GltfFile& file, const tinygltf::OrthographicCamera& source,
                       const std::string& place, Camera& camera) {
  if (!(std::abs(source.ymag) > 0) || !std::isfinite(source.ymag))
    fail(file, place, fmt::format("ymag {} is not a size", source.ymag));
  if (!(source.znear >= 0) || !(source.zfar > source.znear))
    fail(file, place, fmt::format("znear {} and zfar {} are not a range", source.znear, source.zfar));
  camera.perspective = false;
  camera.half_height = std::abs(source.ymag);
  camera.near = source.znear;
  camera.far = source.zfar;
}

}  // namespace

Camera read_camera(const GltfFile& file, std::size_t index) {
  const tinygltf::Camera& source = file.model.cameras[index];
  Camera camera;
  camera.name = source.name;
  const std::string place = fmt::format("cameras[{}]", index);
  if (source.type == "perspective") {
    read_perspective(file, source.perspective, place, camera);
  } else {
    read_orthographic(file, source.orthographic, place, camera);
  }
  return camera;
}

Light read_light(const GltfFile& file, std::size_t index) {
  const tinygltf::Light& source = file.model.lights[index];
  const std::string place = fmt::format("extensions.KHR_lights_punctual.lights[{}]", index);
  Light light;
  if (source.type == "point") {
    light.kind = Light::Kind::kPoint;
  } else if (source.type == "spot") {
    light.kind = Light::Kind::kSpot;
  } else if (source.type != "directional") {
    fail(file, place,
         fmt::format("light type '{}' is not directional, point or spot", source.type.substr(0, 40)));
  }
  if (!source.color.empty() && source.color.size() != 3) fail(file, place, "color: three numbers are due");
  for (int i = 0; i < 3; ++i)
    light.color[i] = static_cast<float>(
        (source.color.empty() ? 1.0 : source.color[static_cast<std::size_t>(i)]) * source.intensity);
  light.range = static_cast<float>(source.range);
  light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
  light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
  const float sum =
      light.color.r + light.color.g + light.color.b + light.range + light.inner_cone + light.outer_cone;
  if (!std::isfinite(sum) || light.range < 0) fail(file, place, "its numbers are not those of a light");
  return light;
}

}  // namespace quadrille::scenes
