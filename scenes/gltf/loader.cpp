/// The scene graph: nodes, where the animation puts them, to instances, cameras and lights, and the images
/// that the materials turn out to need.
#include "scenes/gltf/loader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/gltf/animation.h"
#include "scenes/gltf/file.h"
#include "scenes/gltf/image_light.h"
#include "scenes/gltf/images.h"
#include "scenes/gltf/instancing.h"
#include "scenes/gltf/mesh.h"
#include "scenes/gltf/nodes.h"
#include "scenes/gltf/skin.h"
#include "scenes/gltf/tangents.h"
#include "scenes/gltf/value.h"
#include "scenes/gltf/view.h"

namespace quadrille::scenes {
namespace {

constexpr int kExtentMoments = 32, kFewestMoments = 4;
// nodes and copies of all moments [G: seconds]
constexpr std::size_t kExtentVisits = std::size_t{1} << 22;
// vertices times attributes that targets of weight move
constexpr std::uint64_t kMaxMorphWork = std::uint64_t{1} << 28;
// joints and weights of all posed primitives: a file may show one skin any number of times
constexpr std::size_t kMaxPoseValues = std::size_t{1} << 22;

bool all_finite(const glm::dmat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(static_cast<float>(m[i / 4][i % 4]))) return false;
  }
  return true;
}

}  // namespace

class GltfScene::Reader {
 public:
  Reader(const std::string& path, const GltfChoice& choice)
      : file_(read_gltf_file(path)), choice_(choice), meshes_(file_, scene_) {
    scene_.name = path;
    if (choice.animated) animations_ = choose_animations(file_, choice.animation);
    for (const Animation& animation : animations_) length_ = std::max(length_, animation.length);
    for (std::size_t i = 0; i < file_.model.cameras.size(); ++i)
      scene_.cameras.push_back(read_camera(file_, i));
    visit_nodes();
    if (choice.tangents) make_tangents();
    read_images();
    if (!animations_.empty()) {
      hold_extent();
      pose(0);
    }
  }

  void pose(double time) {
    motions_ = motions_at(animations_, time);
    scene_.instances.clear();
    scene_.copies.clear();
    scene_.poses.clear();
    scene_.lights.clear();
    for (Camera& camera : scene_.cameras) camera.pose.reset();
    visit_nodes();
  }

  [[nodiscard]] SceneData& scene() { return scene_; }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] bool animated() const { return !animations_.empty(); }
  [[nodiscard]] std::size_t image_count() const { return file_.model.images.size(); }
  void print_notes() {
    for (std::string& note : meshes_.take_notes()) file_.notes.push_back(std::move(note));
    scenes::print_notes(file_);
  }

 private:
  struct Visit {
    int node = 0;
    glm::dmat4 parent{1};
    bool visible = true;  ///< what is above it
  };

  [[noreturn]] void fail(int node, const std::string& reason) const { fail(place_of_node(node), reason); }
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const {
    throw user_error("{}: {}: {}", file_.path, place, reason);
  }

  /// A mesh whose skin is posed when all nodes have their places.
  struct SkinnedNode {
    int skin = 0;
    std::size_t pose = 0, first_instance = 0, instances = 0;
  };

  void make_tangents() {
    if (const std::size_t left = add_tangents(scene_); left > 0)
      file_.notes.push_back(fmt::format(
          "{} primitives with normal maps have too many triangles for tangents to be made of all; "
          "their shaders derive a frame",
          left));
  }

  /// Fewer for a scene that takes long to visit.
  int extent_moments() const {
    std::size_t visits = file_.model.nodes.size() + scene_.instances.size();
    for (const auto& copies : scene_.copies) visits += copies.size();
    return std::max(kFewestMoments, static_cast<int>(std::min<std::size_t>(
                                        kExtentMoments, kExtentVisits / std::max<std::size_t>(1, visits))));
  }

  /// The boxes of all instances at moments all over the animation, so that a camera that frames the scene
  /// stands still.
  void hold_extent() {
    std::vector<Bounds> extent(scene_.instances.size());
    const int moments = extent_moments();
    for (int i = 0; i <= moments; ++i) {
      pose(length_ * i / moments);
      extent.resize(std::max(extent.size(), scene_.instances.size()));
      for (std::size_t k = 0; k < scene_.instances.size(); ++k)
        extent[k].add(scene_.box(scene_.instances[k]));
    }
    scene_.extent = std::move(extent);
  }

  // ---- nodes ----

  /// Depth first, children in order, without recursion. A node seen twice would make the graph no tree, or a
  /// loop.
  void visit_nodes() {
    static const NodeMotion kStill;
    worlds_.assign(file_.model.nodes.size(), std::nullopt);
    skinned_.clear();
    pose_values_ = 0;
    morph_work_ = 0;
    copies_.drawn = 0;
    std::vector<Visit> open;
    const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent, bool visible) {
      for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) open.push_back({*it, parent, visible});
    };
    push(scene_roots(file_, choice_.scene), glm::dmat4(1), true);
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      const auto index = static_cast<std::size_t>(visit.node);
      if (visit.node < 0 || index >= worlds_.size())
        fail("nodes", fmt::format("node {} does not exist (the file has {})", visit.node, worlds_.size()));
      if (worlds_[index]) fail(visit.node, "it is reached twice; nodes form a tree");
      const tinygltf::Node& node = file_.model.nodes[index];
      const auto moved = motions_.find(visit.node);
      const NodeMotion& motion = moved == motions_.end() ? kStill : moved->second;
      const glm::dmat4 world = visit.parent * local_matrix(file_, visit.node, motion);
      if (!all_finite(world)) fail(visit.node, "its world matrix is not finite");
      worlds_[index] = world;
      const bool visible = visit.visible && is_visible(node);
      place_node(node, motion, world, visit.node, visible);
      push(node.children, world, visible);
    }
    for (const SkinnedNode& s : skinned_) pose_skinned(s);
  }

  /// What is hidden shows neither mesh nor light; a camera there takes pictures.
  void place_node(const tinygltf::Node& node, const NodeMotion& motion, const glm::dmat4& world, int number,
                  bool visible) {
    if (node.mesh >= 0 && visible) place_mesh(node, motion, world, number);
    if (node.camera >= 0) {
      const auto camera = static_cast<std::size_t>(node.camera);
      if (camera >= scene_.cameras.size())
        fail(number,
             fmt::format("camera {} does not exist (the file has {})", node.camera, scene_.cameras.size()));
      if (!scene_.cameras[camera].pose) scene_.cameras[camera].pose = world;
    }
    if (const auto found = node.extensions.find("KHR_lights_punctual");
        visible && found != node.extensions.end())
      place_light(found->second, world, place_of_node(number));
  }

  void place_mesh(const tinygltf::Node& node, const NodeMotion& motion, const glm::dmat4& world, int at) {
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (mesh >= file_.model.meshes.size())
      fail(at, fmt::format("mesh {} does not exist (the file has {})", node.mesh, file_.model.meshes.size()));
    const std::vector<std::uint32_t>& primitives = meshes_.primitives(node.mesh);
    Pose pose{morph_weights(file_, at, motion), {}, false};
    const bool posed = node.skin >= 0 || std::ranges::any_of(pose.weights, [](float w) { return w != 0; });
    const int number = posed ? static_cast<int>(scene_.poses.size()) : -1;
    if (posed) {
      charge_pose(pose.weights.size() * primitives.size(), at);
      charge_morph(primitives, pose.weights, at);
      scene_.poses.push_back(std::move(pose));
    }
    if (node.skin >= 0) {
      const auto [skin, added] = skins_.try_emplace(node.skin);
      if (added) skin->second = read_skin(file_, node.skin, place_of_node(at));
      charge_pose(skin->second.joints.size() * primitives.size(), at);
      meshes_.read_skinning(node.mesh, skin->second.joints.size(), node.skin);
      skinned_.push_back(
          {node.skin, static_cast<std::size_t>(number), scene_.instances.size(), primitives.size()});
    }
    const std::size_t first = scene_.instances.size();
    for (const std::uint32_t primitive : primitives) {
      const std::string& name = scene_.primitives[primitive].name;
      scene_.instances.push_back(
          {primitive, world, node.name.empty() ? name : node.name + "/" + name, -1, number});
    }
    if (const auto found = node.extensions.find("EXT_mesh_gpu_instancing"); found != node.extensions.end())
      place_copies_of(node, found->second, world, at, first);
  }

  /// A skin places its mesh by joints alone, so that instances of it would all lie in one place.
  void place_copies_of(const tinygltf::Node& node, const tinygltf::Value& extension, const glm::dmat4& world,
                       int at, std::size_t first) {
    const bool skinned = node.skin >= 0;
    if (!skinned && place_copies(file_, extension, place_of_node(at), world, first, scene_, copies_)) return;
    if (!std::exchange(warned_of_copies_, true))
      file_.notes.push_back(fmt::format("{}: EXT_mesh_gpu_instancing {}; it is drawn once", place_of_node(at),
                                        skinned ? "counts for nothing on a node with a skin"
                                                : "has no attribute that says how many copies there are"));
  }

  void charge_pose(std::size_t values, int at) {
    pose_values_ += values;
    if (pose_values_ > kMaxPoseValues)
      fail(at, fmt::format("the scene poses more than {} joints and weights", kMaxPoseValues));
  }

  /// What the host would have to add; many targets may be of one accessor.
  void charge_morph(const std::vector<std::uint32_t>& primitives, const std::vector<float>& weights, int at) {
    for (const std::uint32_t number : primitives) {
      const Primitive& primitive = scene_.primitives[number];
      const std::uint64_t vertices = scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])].count;
      for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
        const auto moved =
            std::ranges::count_if(primitive.targets[t].deltas, [](int delta) { return delta >= 0; });
        if (weights[t] != 0) morph_work_ += vertices * static_cast<std::uint64_t>(moved);
      }
      if (morph_work_ > kMaxMorphWork)
        fail(at, fmt::format("the scene's morph targets move more than {} attributes of vertices",
                             kMaxMorphWork));
    }
  }

  void pose_skinned(const SkinnedNode& s) {
    glm::dmat4 model(1);
    pose_skin(file_, s.skin, skins_.at(s.skin), worlds_, scene_.poses[s.pose], model);
    for (std::size_t i = 0; i < s.instances; ++i) scene_.instances[s.first_instance + i].world = model;
  }

  // ---- lights ----

  void place_light(const tinygltf::Value& extension, const glm::dmat4& world, const std::string& place) {
    const GltfObject object(file_.path, place + ".KHR_lights_punctual", extension);
    const int index = object.index("light", file_.model.lights.size());
    Light light = read_light(file_, static_cast<std::size_t>(index));
    const glm::dvec3 backward(world[2]);
    if (!(glm::length(backward) > 0)) fail(place, "a light on a node whose matrix is singular");
    light.position = glm::dvec3(world[3]);
    light.direction = glm::vec3(-glm::normalize(backward));
    scene_.lights.push_back(light);
  }

  // ---- images ----

  /// Fetches what materials in use refer to, and renumbers their references; the recorder unpacks what is
  /// sampled. With everything asked for, the file's other images follow.
  void read_images() {
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
    for (std::size_t i = 0; !choice_.leave_out && i < file_.model.images.size(); ++i) {
      if (!numbers.contains(static_cast<int>(i))) wanted.push_back(i);
    }
    ImageReader images(file_);
    for (const std::size_t i : wanted) scene_.images.push_back(images.read(i));
    scene_.environment.map = read_image_light(file_, choice_.scene, images);
  }

  GltfFile file_;
  GltfChoice choice_;
  SceneData scene_;
  MeshReader meshes_;
  std::vector<Animation> animations_;
  double length_ = 0;
  NodeMotions motions_;
  std::map<int, Skin> skins_;
  std::vector<std::optional<glm::dmat4>> worlds_;  ///< by node; none: not visited
  std::vector<SkinnedNode> skinned_;
  std::size_t pose_values_ = 0;
  bool warned_of_copies_ = false;
  std::uint64_t morph_work_ = 0;
  PlacedCopies copies_;
};

GltfScene::GltfScene(const std::string& path, const GltfChoice& choice)
    : reader_(std::make_unique<Reader>(path, choice)) {}
GltfScene::~GltfScene() = default;
GltfScene::GltfScene(GltfScene&&) noexcept = default;
GltfScene& GltfScene::operator=(GltfScene&&) noexcept = default;
SceneData& GltfScene::data() { return reader_->scene(); }
double GltfScene::length() const { return reader_->length(); }
bool GltfScene::animated() const { return reader_->animated(); }
std::size_t GltfScene::image_count() const { return reader_->image_count(); }

void GltfScene::print_notes() { reader_->print_notes(); }

void GltfScene::pose(double time) {
  if (reader_->animated()) reader_->pose(time);
}

SceneData load_gltf(const std::string& path) { return std::move(GltfScene(path, {}).data()); }

}  // namespace quadrille::scenes
