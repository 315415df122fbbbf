/// From the name of a scene to a validated stream.
#include "scenes/scene.h"

#include <cmath>

#include "models/base/error.h"
#include "scenes/builtin.h"
#include "scenes/gltf_loader.h"
#include "scenes/recorder.h"

namespace quadrille::scenes {
namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";
constexpr std::uint32_t kMaxTargetSide = 16384;
constexpr std::uint32_t kIdFactor =
    2654435761u;  // odd, so multiplication is a bijection [P: Knuth, The Art of Computer Programming 3, §6.4]
constexpr std::uint32_t kIdFactorInverse = 244002641u;  // kIdFactor * kIdFactorInverse = 1 mod 2^32
static_assert(kIdFactor * kIdFactorInverse == 1u);

bool finite(const std::optional<glm::vec3>& v) { return !v || (std::isfinite(v->x) && std::isfinite(v->y) && std::isfinite(v->z)); }

void check(const SceneOptions& options) {
  if (options.width == 0 || options.height == 0 || options.width > kMaxTargetSide || options.height > kMaxTargetSide) {
    throw user_error("size: {}x{} is outside 1x1 .. {}x{}", options.width, options.height, kMaxTargetSide, kMaxTargetSide);
  }
  if (!finite(options.eye) || !finite(options.at)) throw user_error("camera: eye and point looked at are finite numbers");
}

}  // namespace

traces::CommandStream load_scene(const std::string& file_or_builtin, const SceneOptions& options) {
  check(options);
  SceneData scene = file_or_builtin.starts_with(kBuiltinPrefix) ? build_builtin(file_or_builtin.substr(kBuiltinPrefix.size()))
                                                                : load_gltf(file_or_builtin);
  scene.name = file_or_builtin;
  traces::CommandStream stream = Recorder(scene, options).record();
  traces::validate(stream);
  return stream;
}

std::uint32_t triangle_id_color(std::uint32_t number) { return (number + 1) * kIdFactor; }

std::uint32_t triangle_from_color(std::uint32_t color) { return color * kIdFactorInverse; }

}  // namespace quadrille::scenes
