/// From the name of a scene to a validated stream.
#include "scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "models/base/error.h"
#include "scenes/builtin/builtin.h"
#include "scenes/data/parallel.h"
#include "scenes/environment/environment.h"
#include "scenes/gltf/loader.h"
#include "scenes/material/material_variant.h"
#include "scenes/record/recorder.h"

namespace quadrille::scenes {
namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";
constexpr std::uint32_t kMaxTargetSide = 16384;
// odd, so multiplication is a bijection [P: Knuth, The Art of Computer Programming 3, §6.4]
constexpr std::uint32_t kIdFactor = 2654435761u;
constexpr std::uint32_t kIdFactorInverse = 244002641u;  // kIdFactor * kIdFactorInverse = 1 mod 2^32
static_assert(kIdFactor * kIdFactorInverse == 1u);

bool reads_normal_maps(ShaderSet set) { return set == ShaderSet::kMaterial || set == ShaderSet::kUser; }

bool finite(const std::optional<glm::vec3>& v) {
  return !v || (std::isfinite(v->x) && std::isfinite(v->y) && std::isfinite(v->z));
}

void check(const SceneOptions& options) {
  if (options.width == 0 || options.height == 0 || options.width > kMaxTargetSide ||
      options.height > kMaxTargetSide) {
    throw user_error("size: {}x{} is outside 1x1 .. {}x{}", options.width, options.height, kMaxTargetSide,
                     kMaxTargetSide);
  }
  if (options.exposure && !(*options.exposure >= kLeastExposure && *options.exposure <= kMostExposure))
    throw user_error("exposure: {} is outside {}..{}", *options.exposure, kLeastExposure, kMostExposure);
  if (options.time && !std::isfinite(*options.time))
    throw user_error("time: {} is not a number of seconds", *options.time);
  if (!finite(options.eye) || !finite(options.at))
    throw user_error("camera: eye and point looked at are finite numbers");
}

}  // namespace

/// A file's scene is posed anew for each moment, a built-in one is made anew.
struct Scene::Parts {
  SceneOptions options;
  std::string name, builtin;
  bool animated = false;
  double length = 0;
  std::optional<GltfScene> file;
  std::shared_ptr<const EnvironmentMap> environment;  ///< that the options name
  std::size_t compiled_shaders = 0;
  std::set<int> images;  ///< of the file's scene, that shaders of recorded frames can sample
  float exposure = 1;
  std::optional<std::pair<float, float>> depth_range;
};

Scene::Scene(const std::string& file_or_builtin, const SceneOptions& options)
    : parts_(std::make_unique<Parts>()) {
  check(options);
  parts_->options = options;
  parts_->name = file_or_builtin;
  if (!options.environment.empty()) parts_->environment = load_environment(options.environment);
  const bool animated = options.time.has_value() || !options.animation.empty();
  if (file_or_builtin.starts_with(kBuiltinPrefix)) {
    parts_->builtin = file_or_builtin.substr(kBuiltinPrefix.size());
    parts_->length = builtin_length(parts_->builtin);
    parts_->animated = animated && parts_->length > 0;
    if (!options.scene.empty())
      throw user_error("{}: a built-in scene is one scene; there is no other to choose", file_or_builtin);
    const bool there = parts_->length > 0 && (options.animation == "0" || options.animation == "all");
    if (!options.animation.empty() && !there)
      throw user_error("{}: animation '{}' does not exist; animations: {}", file_or_builtin,
                       options.animation.substr(0, 60), parts_->length > 0 ? "0" : "none");
    return;
  }
  parts_->file.emplace(file_or_builtin,
                       GltfChoice{options.scene, animated, options.animation, options.leave_out,
                                  reads_normal_maps(shader_set(options))});
  parts_->animated = parts_->file->animated();
  parts_->length = parts_->file->length();
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
bool Scene::animated() const { return parts_->animated; }
double Scene::length() const { return parts_->length; }
bool Scene::repeats() const { return parts_->animated && !parts_->file; }

std::size_t Scene::unused_images() const {
  return parts_->file ? parts_->file->image_count() - parts_->images.size() : 0;
}

void Scene::unpack_images() {
  if (!parts_->file) return;
  const std::vector<SceneImage>& images = parts_->file->data().images;
  const std::vector<int> used(parts_->images.begin(), parts_->images.end());
  parallel_for(used.size(), [&](std::size_t i) { (void)images[static_cast<std::size_t>(used[i])].pixels(); });
}

std::optional<std::pair<float, float>> Scene::depth_range() const { return parts_->depth_range; }

float Scene::exposure() const { return parts_->exposure; }

std::size_t Scene::compiled_shaders() const { return parts_->compiled_shaders; }

traces::CommandStream Scene::record(const Moment& moment) {
  SceneOptions options = parts_->options;
  options.orbit = moment.orbit;
  SceneData made;
  if (parts_->file) {
    parts_->file->pose(moment.time);
  } else {
    made = build_builtin(parts_->builtin, parts_->animated ? moment.time : 0);
  }
  SceneData& scene = parts_->file ? parts_->file->data() : made;
  scene.name = parts_->name;
  if (parts_->environment) scene.environment.map = parts_->environment;
  const RecordPasses passes = parts_->file ? nullptr : builtin_passes(parts_->builtin);
  // Which triangle is seen, a single pass tells, of a scene that has some.
  if (passes != nullptr && (!options.visibility || scene.instances.empty())) {
    traces::CommandStream stream = passes(scene, options);
    traces::validate(stream);
    return stream;
  }
  Recorder recorder(scene, options);
  traces::CommandStream stream = recorder.record();
  parts_->compiled_shaders += recorder.compiled_shaders();
  parts_->images.insert(recorder.images().begin(), recorder.images().end());
  parts_->exposure = recorder.exposure();
  parts_->depth_range.reset();
  if (recorder.depth_range())
    parts_->depth_range = {recorder.depth_range()->nearest, recorder.depth_range()->farthest};
  traces::validate(stream);
  if (parts_->file) parts_->file->print_notes();
  return stream;
}

traces::CommandStream load_scene(const std::string& file_or_builtin, const SceneOptions& options) {
  return Scene(file_or_builtin, options).record({options.time.value_or(0), options.orbit});
}

std::uint32_t triangle_id_color(std::uint32_t number) { return (number + 1) * kIdFactor; }

std::uint32_t triangle_from_color(std::uint32_t color) { return color * kIdFactorInverse; }

}  // namespace quadrille::scenes
