/// The scene graph: nodes to instances, cameras and lights, and the images that its materials turn out to need.
#include "scenes/gltf_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/gltf_file.h"
#include "scenes/gltf_instancing.h"
#include "scenes/gltf_mesh.h"
#include "scenes/image_header.h"
#include "scenes/parallel.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kFreePixels = std::uint64_t{1} << 26,
                        kPixelsAByte = 32;  // [G: half a gigabyte with mips, and flat textures of real scenes]
constexpr std::size_t kMaxCopies = std::size_t{1} << 20;  // of all nodes together

bool all_finite(const glm::dmat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(static_cast<float>(m[i / 4][i % 4]))) return false;
  }
  return true;
}

class SceneReader {
 public:
  explicit SceneReader(const std::string& path) : file_(read_gltf_file(path)), meshes_(file_, scene_) { scene_.name = path; }

  SceneData read() {
    read_cameras();
    visit_nodes();
    decode_images();
    return std::move(scene_);
  }

 private:
  struct Visit {
    int node = 0;
    glm::dmat4 parent{1};
  };

  [[noreturn]] void fail(const std::string& place, const std::string& reason) const {
    throw user_error("{}: {}: {}", file_.path, place, reason);
  }

  void warn_once(bool& said, const char* what) const {
    if (!said) fmt::print(stderr, "{}: {}\n", file_.path, what);
    said = true;
  }

  // ---- cameras ----

  void read_perspective(const tinygltf::PerspectiveCamera& source, const std::string& place, Camera& camera) const {
    if (!(source.yfov > 0 && source.yfov < std::numbers::pi)) fail(place, fmt::format("yfov {} is outside 0..pi", source.yfov));
    if (!(source.znear > 0) || !std::isfinite(source.znear)) fail(place, fmt::format("znear {} is not positive", source.znear));
    if (source.zfar != 0 && !(source.zfar > source.znear))
      fail(place, fmt::format("zfar {} is not beyond znear {}", source.zfar, source.znear));
    camera.yfov = source.yfov;
    camera.near = source.znear;
    camera.far = source.zfar == 0 ? std::nullopt : std::optional<double>(source.zfar);  // tinygltf has 0 for a missing one: infinite
  }

  void read_orthographic(const tinygltf::OrthographicCamera& source, const std::string& place, Camera& camera) const {
    if (!(std::abs(source.ymag) > 0) || !std::isfinite(source.ymag)) fail(place, fmt::format("ymag {} is not a size", source.ymag));
    if (!(source.znear >= 0) || !(source.zfar > source.znear))
      fail(place, fmt::format("znear {} and zfar {} are not a range", source.znear, source.zfar));
    camera.perspective = false;
    camera.half_height = std::abs(source.ymag);
    camera.near = source.znear;
    camera.far = source.zfar;
  }

  void read_cameras() {
    for (std::size_t i = 0; i < file_.model.cameras.size(); ++i) {
      const tinygltf::Camera& source = file_.model.cameras[i];
      Camera camera;
      camera.name = source.name;
      const std::string place = fmt::format("cameras[{}]", i);
      if (source.type == "perspective") {
        read_perspective(source.perspective, place, camera);
      } else {
        read_orthographic(source.orthographic, place, camera);
      }
      scene_.cameras.push_back(std::move(camera));
    }
  }

  // ---- nodes ----

  glm::dmat4 local_matrix(const tinygltf::Node& node, const std::string& place) const {
    const auto sized = [&](const std::vector<double>& values, std::size_t size, const char* member) {
      if (!values.empty() && values.size() != size) fail(place, fmt::format("{}: {} numbers instead of {}", member, values.size(), size));
      return !values.empty();
    };
    glm::dmat4 m(1);
    if (sized(node.matrix, 16, "matrix")) {
      for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      return m;
    }
    if (sized(node.rotation, 4, "rotation")) {
      const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      const double length = glm::length(q);
      if (!(length > 0) || !std::isfinite(length)) fail(place, "rotation: not a quaternion");
      m = glm::mat4_cast(q / length);
    }
    if (sized(node.scale, 3, "scale")) {
      for (int i = 0; i < 3; ++i) m[i] *= node.scale[static_cast<std::size_t>(i)];
    }
    if (sized(node.translation, 3, "translation")) m[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
    return m;
  }

  /// The roots of the file's scene; without any scene, the nodes that are nobody's child. [glTF2.0 #scenes]
  std::vector<int> roots() const {
    const tinygltf::Model& model = file_.model;
    if (!model.scenes.empty()) {
      const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
      if (static_cast<std::size_t>(scene) >= model.scenes.size())
        fail("scene", fmt::format("scene {} does not exist (the file has {})", scene, model.scenes.size()));
      return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<bool> child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes) {
      for (const int c : node.children) {
        if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = true;
      }
    }
    std::vector<int> result;
    for (std::size_t i = 0; i < child.size(); ++i) {
      if (!child[i]) result.push_back(static_cast<int>(i));
    }
    return result;
  }

  /// Depth first, children in order, without recursion. A node seen twice would make the graph no tree, or a loop.
  void visit_nodes() {
    std::vector<bool> seen(file_.model.nodes.size());
    std::vector<Visit> open;
    const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
      for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) open.push_back({*it, parent});
    };
    push(roots(), glm::dmat4(1));
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      const auto index = static_cast<std::size_t>(visit.node);
      if (visit.node < 0 || index >= seen.size())
        fail("nodes", fmt::format("node {} does not exist (the file has {})", visit.node, seen.size()));
      const std::string place = fmt::format("nodes[{}]", visit.node);
      if (seen[index]) fail(place, "it is reached twice; nodes form a tree");
      seen[index] = true;
      const tinygltf::Node& node = file_.model.nodes[index];
      const glm::dmat4 world = visit.parent * local_matrix(node, place);
      if (!all_finite(world)) fail(place, "its world matrix is not finite");
      place_node(node, world, place);
      push(node.children, world);
    }
  }

  void place_node(const tinygltf::Node& node, const glm::dmat4& world, const std::string& place) {
    if (node.mesh >= 0) place_mesh(node, world, place);
    if (node.camera >= 0) {
      const auto camera = static_cast<std::size_t>(node.camera);
      if (camera >= scene_.cameras.size())
        fail(place, fmt::format("camera {} does not exist (the file has {})", node.camera, scene_.cameras.size()));
      if (!scene_.cameras[camera].pose) scene_.cameras[camera].pose = glm::mat4(world);
    }
    if (const auto found = node.extensions.find("KHR_lights_punctual"); found != node.extensions.end())
      place_light(found->second, world, place);
  }

  void place_mesh(const tinygltf::Node& node, const glm::dmat4& world, const std::string& place) {
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (mesh >= file_.model.meshes.size())
      fail(place, fmt::format("mesh {} does not exist (the file has {})", node.mesh, file_.model.meshes.size()));
    if (node.skin >= 0) warn_once(said_skin_, "skins are not applied; skinned meshes stay in their bind pose");
    for (const tinygltf::Primitive& primitive : file_.model.meshes[mesh].primitives) {
      if (!primitive.targets.empty()) warn_once(said_morph_, "morph targets are not applied");
    }
    const std::size_t first = scene_.instances.size();
    for (const std::uint32_t primitive : meshes_.primitives(node.mesh)) {
      const std::string& name = scene_.primitives[primitive].name;
      scene_.instances.push_back({primitive, glm::mat4(world), node.name.empty() ? name : node.name + "/" + name});
    }
    if (const auto found = node.extensions.find("EXT_mesh_gpu_instancing"); found != node.extensions.end())
      copy_instances(first, world, read_instances(file_, found->second, place), place);
  }

  /// Turns the instances from `first` on into instanced draws: one of the copies that mirror and one of those that do not, since they face the other way.
  void copy_instances(std::size_t first, const glm::dmat4& world, const std::vector<glm::dmat4>& local, const std::string& place) {
    std::array<std::vector<glm::mat4>, 2> sides;
    for (const glm::dmat4& matrix : local) {
      const glm::dmat4 placed = world * matrix;
      if (!all_finite(placed)) fail(place, "the matrix of one of its instances is not finite");
      sides[glm::determinant(glm::dmat3(placed)) < 0 ? 1 : 0].emplace_back(placed);
    }
    copies_ += local.size();
    if (copies_ > kMaxCopies) fail(place, fmt::format("the scene has more than {} instances", kMaxCopies));
    const std::vector<Instance> originals(scene_.instances.begin() + static_cast<std::ptrdiff_t>(first), scene_.instances.end());
    scene_.instances.resize(first);
    for (std::vector<glm::mat4>& side : sides) {
      if (side.empty()) continue;
      for (Instance instance : originals) {
        instance.copies = static_cast<int>(scene_.copies.size());
        scene_.instances.push_back(std::move(instance));
      }
      scene_.copies.push_back(std::move(side));
    }
  }

  // ---- lights ----

  Light read_light(const tinygltf::Light& source, const std::string& place) const {
    Light light;
    if (source.type == "point") {
      light.kind = Light::Kind::kPoint;
    } else if (source.type == "spot") {
      light.kind = Light::Kind::kSpot;
    } else if (source.type != "directional") {
      fail(place, fmt::format("light type '{}' is not directional, point or spot", source.type.substr(0, 40)));
    }
    if (!source.color.empty() && source.color.size() != 3) fail(place, "color: three numbers are due");
    for (int i = 0; i < 3; ++i)
      light.color[i] = static_cast<float>((source.color.empty() ? 1.0 : source.color[static_cast<std::size_t>(i)]) * source.intensity);
    light.range = static_cast<float>(source.range);
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    const float sum = light.color.r + light.color.g + light.color.b + light.range + light.inner_cone + light.outer_cone;
    if (!std::isfinite(sum) || light.range < 0) fail(place, "its numbers are not those of a light");
    return light;
  }

  void place_light(const tinygltf::Value& extension, const glm::dmat4& world, const std::string& place) {
    const int index = extension.Has("light") ? extension.Get("light").GetNumberAsInt() : -1;
    const auto& lights = file_.model.lights;
    if (index < 0 || static_cast<std::size_t>(index) >= lights.size())
      fail(place, fmt::format("light {} does not exist (the file has {})", index, lights.size()));
    Light light = read_light(lights[static_cast<std::size_t>(index)], fmt::format("extensions.KHR_lights_punctual.lights[{}]", index));
    const glm::dvec3 backward(world[2]);
    if (!(glm::length(backward) > 0)) fail(place, "a light on a node whose matrix is singular");
    light.position = glm::vec3(world[3]);
    light.direction = glm::vec3(-glm::normalize(backward));
    scene_.lights.push_back(light);
  }

  // ---- images ----

  /// Decodes only what materials in use refer to, and renumbers their references.
  void decode_images() {
    std::map<int, int> numbers;  // the file's to the scene's
    std::vector<std::size_t> wanted;
    for (Material& material : scene_.materials) {
      for (TextureUse& use : material.textures) {
        if (use.image < 0) continue;
        const auto [entry, added] = numbers.try_emplace(use.image, static_cast<int>(wanted.size()));
        if (added) wanted.push_back(static_cast<std::size_t>(use.image));
        use.image = entry->second;
      }
    }
    check_image_budget(wanted);
    scene_.images.resize(wanted.size());
    parallel_for(wanted.size(),
                 [&](std::size_t i) { scene_.images[i] = decode_image(encoded_image(file_, wanted[i]), image_place(wanted[i])); });
    for (const std::size_t i : wanted) scene_.image_names.push_back(image_name(i));
  }

  /// A few bytes can say that they are many pixels: what a scene may unpack grows with what it brings.
  void check_image_budget(const std::vector<std::size_t>& wanted) const {
    std::uint64_t pixels = 0, bytes = 0;
    for (const std::size_t i : wanted) {
      const auto encoded = encoded_image(file_, i);
      const ImageHeader header = check_image_header(encoded, image_place(i));
      pixels += std::uint64_t{header.width} * header.height;
      bytes += encoded.size();
      if (pixels > kFreePixels + kPixelsAByte * bytes) {
        fail(fmt::format("images[{}]", i),
             fmt::format("the images up to here are {} pixels in {} bytes of files; legal are {} and {} more a byte", pixels, bytes,
                         kFreePixels, kPixelsAByte));
      }
    }
  }

  std::string image_name(std::size_t index) const {
    const tinygltf::Image& image = file_.model.images[index];
    if (!image.name.empty()) return image.name;
    return image.uri.empty() ? fmt::format("images[{}]", index) : image.uri;
  }

  std::string image_place(std::size_t index) const {
    const std::string& uri = file_.model.images[index].uri;
    return fmt::format("{}: images[{}]{}", file_.path, index, uri.empty() ? "" : " '" + uri.substr(0, 200) + "'");
  }

  GltfFile file_;
  SceneData scene_;
  MeshReader meshes_;
  std::size_t copies_ = 0;
  bool said_skin_ = false, said_morph_ = false;
};

}  // namespace

SceneData load_gltf(const std::string& path) { return SceneReader(path).read(); }

}  // namespace quadrille::scenes
