/// A scene in memory, between the file it came from and the commands it becomes.
///
/// glTF's conventions: right-handed world, y up, metres; texture coordinates start at the upper left; a front
/// face is counter-clockwise; matrices are column-major and act on column vectors. Colours are linear. Where
/// things are is kept in double: what is far from the origin may have to be moved before it is rounded
/// (scenes/view/world_range.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/image/image_io.h"
#include "scenes/image/texture_file.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// An axis-aligned box; empty until a point is added.
struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  [[nodiscard]] bool empty() const { return !(low.x <= high.x); }
  [[nodiscard]] glm::vec3 center() const { return 0.5F * (low + high); }
  /// Half the diagonal: the radius of a sphere around the box.
  [[nodiscard]] float radius() const;
  void add(const glm::vec3& point);
  void add(const Bounds& box);
  /// The box around this one's eight corners after `matrix`.
  [[nodiscard]] Bounds transformed(const glm::mat4& matrix) const;
};

/// Vertex attributes, in the order of their shader locations.
enum class Semantic : std::uint8_t { kPosition, kNormal, kTangent, kUv0, kUv1, kColor };
inline constexpr std::size_t kSemantics = 6;

/// One tightly packed stream of vertex attributes or indices; primitives share them.
struct Array {
  std::string name;
  traces::Format format = traces::Format::kUndefined;  ///< attributes; indices have none
  std::uint32_t count = 0;
  std::vector<std::byte> data;
};

/// What a morph target adds to the attributes at weight one, as float vectors of 2 (texture coordinates), 3
/// or 4 (colours) components.
struct MorphTarget {
  std::array<int, kSemantics> deltas{-1, -1, -1, -1, -1, -1};  ///< into `SceneData::arrays`; -1: nothing
  Bounds reach;                                                ///< of the position deltas
};

/// Joints that move a vertex, and how much each counts: one set of four.
struct JointSet {
  /// into `SceneData::arrays`: integers of 8 or 16 bits, and fractions; -1: absent
  int joints = -1, weights = -1;
};

/// How a primitive's points, lines or triangles become pixels. glTF's are one pixel wide.
struct RasterStyle {
  traces::PolygonMode polygon_mode = traces::PolygonMode::kFill;
  traces::LineMode line_mode = traces::LineMode::kBresenham;
  float line_width = 1, point_size = 1;  ///< pixels
};

struct Primitive {
  std::string name;
  traces::Topology topology = traces::Topology::kTriangleList;
  RasterStyle style;
  std::array<int, kSemantics> attributes{-1, -1, -1, -1, -1, -1};  ///< into `SceneData::arrays`; -1: absent
  int indices = -1;                                                ///< into `SceneData::arrays`; -1: none
  traces::IndexType index_type = traces::IndexType::kUint16;
  std::uint32_t count = 0;  ///< indices, or vertices without them
  /// an index of all ones ends a strip or fan
  bool restarts = false;
  /// some of its normals are zero: the faces of those vertices are drawn with their own
  bool partial_normals = false;
  int material = 0;
  Bounds bounds;  ///< model space
  std::vector<MorphTarget> targets;
  std::array<JointSet, 2> joint_sets;
  /// by joint: the vertices that it moves; one more than the largest joint in use
  std::vector<Bounds> joint_boxes;
};

/// Texture roles; the shader binds slot i at binding 1 + i. From kSpecular on they belong to
/// `MaterialLayers`.
enum class TextureSlot : std::uint8_t {
  kBaseColor,
  kMetallicRoughness,
  kNormal,
  kOcclusion,
  kEmissive,
  kSpecular,            ///< a: weight
  kSpecularColor,       ///< sRGB; with specular-glossiness rgb: reflectance, a: glossiness
  kClearcoat,           ///< r
  kClearcoatRoughness,  ///< g
  kClearcoatNormal,
  kSheenColor,      ///< sRGB
  kSheenRoughness,  ///< a
  kTransmission,    ///< r
  kThickness        ///< g
};
inline constexpr std::size_t kBaseTextureSlots = 5, kTextureSlots = 14;

/// A picture that is unpacked when it is first looked at: what no shader of a frame samples stays packed.
class SceneImage {
 public:
  struct Size {
    std::uint32_t width = 0, height = 0;
  };
  using Unpack = std::function<Rgba8Image()>;
  using Source = std::function<std::shared_ptr<const Rgba8Image>()>;

  SceneImage(std::string name, Rgba8Image pixels)
      : name_(std::move(name)),
        size_({pixels.width, pixels.height}),
        pixels_(std::make_shared<const Rgba8Image>(std::move(pixels))) {}
  /// `unpack` throws `UserError`; any number of times, on any thread. `size`: what the pixels will have;
  /// none: they have to be unpacked to know it.
  SceneImage(std::string name, std::optional<Size> size, Unpack unpack)
      : name_(std::move(name)), size_(size), unpack_(std::move(unpack)) {}
  /// Blocks with levels of their own. As a picture it is the finest level, decoded.
  SceneImage(std::string name, const std::shared_ptr<const TextureFile>& file);
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Null: levels are computed from the pixels.
  [[nodiscard]] const std::shared_ptr<const TextureFile>& file() const { return file_; }
  [[nodiscard]] bool packed() const { return pixels_ == nullptr; }
  [[nodiscard]] bool knows_size() const { return size_.has_value(); }
  /// Unpacks the image where its size is not known otherwise. Not for two threads at a time.
  [[nodiscard]] Size size() const {
    if (!size_) size_ = {pixels().width, pixels().height};
    return *size_;
  }
  /// Unpacks the image once, for good. Not for two threads at a time.
  [[nodiscard]] const Rgba8Image& pixels() const {
    if (!pixels_) pixels_ = std::make_shared<const Rgba8Image>(unpack_());
    return *pixels_;
  }
  /// What brings the pixels when the scene is gone: those that are unpacked now, or a copy that is unpacked
  /// at each call. Throws `UserError`, also when they have another size than the image said.
  [[nodiscard]] Source source() const;

 private:
  std::string name_;
  mutable std::optional<Size> size_;
  Unpack unpack_;
  std::shared_ptr<const TextureFile> file_;
  mutable std::shared_ptr<const Rgba8Image> pixels_;  ///< null: packed
};

struct TextureUse {
  int image = -1;  ///< into `SceneData::images`; -1: none
  traces::Sampler sampler;
  int uv_set = 0;
  bool transformed = false;
  glm::vec3 u_row{1, 0, 0}, v_row{0, 1, 0};  ///< u' = dot(u_row, (u, v, 1)), likewise v'
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

/// What extensions of glTF add to a material. A member at its default adds nothing.
struct MaterialLayers {
  /// the dielectric's reflectance differs from 0.04 [KHR_materials_ior, KHR_materials_specular]
  bool specular = false;
  glm::vec3 specular_color{0.04F};  ///< reflectance at normal incidence, not yet limited to 1
  float specular_weight = 1;
  /// `specular_color` is the reflectance of all; no metals [KHR_materials_pbrSpecularGlossiness]
  bool specular_glossiness = false;
  float clearcoat = 0, clearcoat_roughness = 0, clearcoat_normal_scale = 1;
  glm::vec3 sheen_color{0};
  float sheen_roughness = 0;
  float transmission = 0;
  /// log2 of what the whole thickness lets through, 0 or less [KHR_materials_volume]
  glm::vec3 absorption{0};
  [[nodiscard]] bool coats() const { return clearcoat > 0; }
  [[nodiscard]] bool sheens() const { return sheen_color != glm::vec3(0); }
  [[nodiscard]] bool transmits() const { return transmission > 0; }
  [[nodiscard]] bool any() const { return specular || coats() || sheens() || transmits(); }
};

struct Material {
  std::string name = "default";
  glm::vec4 base_color{1};
  float metallic = 1, roughness = 1, normal_scale = 1, occlusion_strength = 1;
  glm::vec3 emissive{0};
  AlphaMode alpha = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false, unlit = false;
  MaterialLayers layers;
  std::array<TextureUse, kTextureSlots> textures;
  /// Is what lies behind seen through it? Such draws come after the others, from back to front.
  [[nodiscard]] bool see_through() const { return alpha == AlphaMode::kBlend || layers.transmits(); }
  [[nodiscard]] const TextureUse& texture(TextureSlot slot) const {
    return textures[static_cast<std::size_t>(slot)];
  }
  [[nodiscard]] TextureUse& texture(TextureSlot slot) { return textures[static_cast<std::size_t>(slot)]; }
};

/// The upper three rows of an affine matrix.
using JointMatrix = std::array<glm::vec4, 3>;

/// How the vertices of a mesh are moved before its model matrix is applied.
struct Pose {
  std::vector<float> weights;       ///< by morph target; empty: no morphing
  std::vector<JointMatrix> joints;  ///< from the mesh's space at rest; empty: no skin
  bool mirrored = false;            ///< the joints turn front faces over
};

struct Instance {
  std::uint32_t primitive = 0;
  glm::dmat4 world{1};
  std::string label;
  /// into `SceneData::copies`: drawn once with each of these matrices instead of `world`; -1: drawn once
  int copies = -1;
  int pose = -1;  ///< into `SceneData::poses`; -1: as the arrays have it
};

struct Light {
  enum class Kind : std::uint8_t { kDirectional, kPoint, kSpot };
  Kind kind = Kind::kDirectional;
  glm::vec3 color{1};  ///< times intensity: lux (directional) or candela
  glm::dvec3 position{0};
  glm::vec3 direction{0, 0, -1};                  ///< the way light travels, unit length
  float range = 0;                                ///< metres; 0: unlimited
  float inner_cone = 0, outer_cone = 0.7853982F;  ///< radians, spot
};

struct Camera {
  std::string name;
  bool perspective = true;
  double yfov = 1.0471975511965976;  ///< radians
  double half_height = 1;            ///< orthographic
  double near = 0.1;
  std::optional<double> far = 100;  ///< none: infinite (perspective)
  std::optional<glm::dmat4> pose;   ///< the node's world matrix; none: no node carries it
};

struct EnvironmentMap;

/// Light from everywhere, as the material shader knows it: radiance from straight above and from straight
/// below, or a map of it (scenes/data/environment_map.h).
struct Environment {
  glm::vec3 sky{0.50F, 0.57F, 0.68F}, ground{0.20F, 0.18F, 0.16F};
  std::shared_ptr<const EnvironmentMap> map{};
};

/// Where things are: what of a scene moves with its world.
struct Placements {
  std::vector<Instance> instances;
  /// world matrices of one draw, all of them mirror or none does; never empty
  std::vector<std::vector<glm::dmat4>> copies;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  /// What a camera that frames the scene has to hold, world space, where that is more than this moment: the
  /// boxes of all of an animation's moments.
  std::vector<Bounds> extent;
};

struct SceneData : Placements {
  std::string name;
  std::vector<SceneImage> images;
  std::vector<Array> arrays;
  std::vector<Material> materials;
  std::vector<Primitive> primitives;
  std::vector<Pose> poses;
  Environment environment;
  glm::vec3 background{0.30F, 0.42F, 0.58F};
  bool depth = true;  ///< false: draw without depth test and depth attachment
  /// GLSL of the fragment shader of a second pass over the picture (scenes/record/post_pass.h); empty: none
  std::string post_shader;
  using VisitModelBox = std::function<void(const Bounds&, const glm::mat4&)>;
  /// Boxes that, each moved by a matrix into model space, hold an instance as it is posed together.
  void visit_model_boxes(const Instance& instance, const VisitModelBox& visit) const;
  /// A box that holds an instance as it is posed, model space.
  [[nodiscard]] Bounds model_box(const Instance& instance) const;
  /// A box that holds an instance with all its copies, world space.
  [[nodiscard]] Bounds box(const Instance& instance) const;
  /// The box around what a camera has to hold.
  [[nodiscard]] Bounds bounds() const;
};

/// A scene where its own placements, or others of the same things, put it. Refers to both.
struct PlacedScene {
  using VisitBox = std::function<void(const Bounds&)>;
  PlacedScene(const SceneData& scene)  // NOLINT(google-explicit-constructor): a scene is placed as it is
      : data(scene), at(scene) {}
  PlacedScene(const SceneData& scene, const Placements& placements) : data(scene), at(placements) {}
  const SceneData& data;
  const Placements& at;
  /// The boxes of an instance, world space: each copy's by itself.
  void visit_boxes(const Instance& instance, const VisitBox& visit) const;
  /// The boxes that a camera has to hold: the extent, or those of all instances.
  void visit_boxes(const VisitBox& visit) const;
  /// The box around an instance with all its copies.
  [[nodiscard]] Bounds box(const Instance& instance) const;
  /// The box around all that a camera has to hold.
  [[nodiscard]] Bounds bounds() const;
};

}  // namespace quadrille::scenes
