/// Turns a scene and a view into commands: the part of a renderer that a driver sees.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"
#include "scenes/data/vertex_values.h"
#include "scenes/material/frame_block.h"
#include "scenes/material/shader_library.h"
#include "scenes/record/pose_streams.h"
#include "scenes/view/camera.h"
#include "scenes/view/world_range.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// Push constants of every draw (`PerDraw` of scenes/material/shaders/interface.glsl).
struct DrawConstants {
  glm::mat4 model{1};
  std::array<glm::vec4, 3> normal_matrix{};  ///< columns of a mat3, 16 bytes apart
  std::uint32_t draw_id = 0, first_triangle = 0;
  float handedness = 1;
};
inline constexpr std::size_t kDrawConstantBytes = 124;

/// Does the matrix turn front faces into back faces?
[[nodiscard]] bool mirrors(const glm::mat4& world);
/// Inverse transpose of the upper 3x3, scaled so that its longest column is one long: columns, 16 bytes
/// apart. `mirrored`: it turns front faces into back faces, by itself or with the pose of its mesh.
[[nodiscard]] std::array<glm::vec4, 3> normal_matrix(const glm::mat4& world, bool mirrored);

// Slots of the bound state: pipeline, material set, index buffer, pose set, then a vertex stream for each
// location.
inline constexpr std::size_t kPipelineSlot = 0, kSetSlot = 1, kIndexSlot = 2, kPoseSlot = 3, kVertexSlot = 4,
                             kLocations = 16;
inline constexpr std::uint32_t kFrameSet = 0, kMaterialSet = 1, kPoseSet = 2;
/// Vertex binding and first location of an instanced draw's matrices.
inline constexpr std::uint32_t kCopiesBinding = 10;

/// Records one frame.
class Recorder {
 public:
  Recorder(const SceneData& scene, const SceneOptions& options);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  [[nodiscard]] traces::CommandStream record();
  [[nodiscard]] std::size_t compiled_shaders() const { return shaders_.compiled() + more_shaders_; }
  [[nodiscard]] float exposure() const { return exposure_; }
  /// Of the recorded frame, if it is a picture of depths.
  [[nodiscard]] const std::optional<DepthRange>& depth_range() const { return depth_range_; }
  /// Images of the scene that a shader of the recorded frame can sample.
  [[nodiscard]] const std::set<int>& images() const { return images_; }

 private:
  struct TextureKey {
    int image = 0;
    bool srgb = false;
    bool premultiplied = false;
    auto operator<=>(const TextureKey&) const =
        default;  // NOLINT(modernize-use-nullptr): the comparison with zero that it stands for
  };

  /// What one draw reads: the variant of its shaders, and its vertex streams by location.
  struct Geometry {
    Variant variant;
    std::vector<std::pair<std::uint32_t, traces::Index>> streams;  ///< location, buffer
    std::vector<traces::Format> formats;                           ///< of the streams
    traces::Index pose_set = traces::kNone;
    bool mirrored = false;
    /// drawn by indices of the painter's, as a list of points, lines or triangles
    bool listed = false;
  };

  /// What a draw binds.
  struct States {
    Geometry geometry;
    traces::Index pipeline = traces::kNone, material_set = traces::kNone;
  };

  /// Something that the painter draws piece by piece: an instance, or one of its copies.
  struct Canvas {
    const Instance* instance = nullptr;
    glm::mat4 world{1};
    const Corners* corners = nullptr;
    const Array* positions = nullptr;
    std::shared_ptr<const States> states;  ///< copies share them
  };
  /// A point, line or triangle, where its corners begin, and how far away it is.
  struct Piece {
    double distance = 0;
    std::uint32_t canvas = 0, first_corner = 0;
  };

  /// What the host has posed: format and buffer by semantic; kNone: the mesh's own.
  using PosedStreams = std::array<std::pair<traces::Format, traces::Index>, kSemantics>;

  /// Are its fragments put in order by their depths?
  [[nodiscard]] bool order_independent(const Material& material) const;
  /// Lets the pass that began at a command keep the fragments of its order-independent draws.
  void keep_fragments(std::size_t begin);
  /// Indices into the scene's instances: opaque and masked ones in scene order, then blended ones back to
  /// front, then order-independent ones in scene order.
  [[nodiscard]] std::vector<std::size_t> draw_order() const;
  void record_arrays();
  void record_textures();
  /// Adds textures behind what the stream holds: packed, or unpacked with their mip chains, on all cores.
  void add_textures(const std::vector<TextureKey>& keys);
  /// All of them, or where they may stay packed those that do not know their size.
  void unpack_images(const std::vector<TextureKey>& keys);
  /// A texture as a slot of a variant's shaders wants it.
  [[nodiscard]] static TextureKey texture_key(int image, std::size_t slot, const Variant& v);
  void leave_out_unread(Variant& variant);
  void record_frame_set();
  void record_draws();
  /// Adds the environment's map and what goes with it to a set.
  void add_environment(traces::DescriptorSet& set);
  /// Draws it behind everything, if it is shown.
  void record_background();
  void add_second_pass();
  void record_instance(const Instance& instance);
  /// Draws of the copies of an instance: one instanced draw, or single ones where the shader must tell their
  /// triangles apart or is not ours.
  void record_copies(const Instance& instance, Geometry geometry);
  void record_draw(const Instance& instance, const Geometry& geometry, const glm::mat4& world,
                   std::uint32_t copies);
  /// The matrices of its copies, from back to front where `sorted`.
  [[nodiscard]] std::vector<glm::mat4> ordered_copies(const Instance& instance, bool sorted) const;
  /// All primitives of all draws, from back to front by their centres. Ties are drawn in the scene's order.
  void record_as_painter();
  [[nodiscard]] std::vector<Canvas> canvases();
  [[nodiscard]] std::vector<Piece> pieces_from_back(const std::vector<Canvas>& canvases) const;
  void record_run(const Canvas& canvas, std::uint32_t first, std::uint32_t count);
  /// Calls `visit(world matrix)` for an instance, or for each of its copies.
  template <class Visit>
  void for_each_copy(const Instance& instance, const Visit& visit) const {
    if (instance.copies < 0) return visit(glm::mat4(instance.world));
    for (const glm::dmat4& copy : placed_.at.copies[static_cast<std::size_t>(instance.copies)])
      visit(glm::mat4(copy));
  }
  [[nodiscard]] const Corners& corners(std::uint32_t primitive);
  /// Where the vertices of an instance are, model space, after its pose.
  [[nodiscard]] const Array& host_positions(const Instance& instance);
  [[nodiscard]] DepthRange find_depth_range();
  /// Is there a depth attachment?
  [[nodiscard]] bool has_depth() const { return scene_.depth && options_.order == DrawOrder::kFile; }
  [[nodiscard]] traces::Index copies_buffer(const Instance& instance, bool sorted, bool mirrored);
  [[nodiscard]] Geometry geometry(const Instance& instance);
  void pose(const Instance& instance, Geometry& geometry);
  [[nodiscard]] const PosedStreams& posed_streams(const Instance& instance, bool skinned);
  void add_stream(Geometry& geometry, std::uint32_t location, const Array& array, traces::Index buffer);
  [[nodiscard]] traces::Index array_buffer(int array);
  [[nodiscard]] traces::Index pose_set(const std::vector<std::byte>& block);
  void bind(const Instance& instance, const Geometry& geometry) {
    bind(scene_.primitives[instance.primitive], states(instance, geometry));
  }
  [[nodiscard]] States states(const Instance& instance, Geometry geometry);
  void bind(const Primitive& primitive, const States& states);
  void bind_geometry(const Primitive& primitive, const Geometry& geometry);
  void push_constants(const glm::mat4& world, bool mirrored);
  void bind_once(const traces::Command& command, std::size_t slot);
  [[nodiscard]] traces::Index pipeline(const Primitive& primitive, const Material& material,
                                       const Geometry& geometry);
  [[nodiscard]] traces::Index material_set(int material, const Variant& variant);
  [[nodiscard]] traces::Index material_block(int material);
  [[nodiscard]] traces::Index sampler(const traces::Sampler& wanted);
  [[nodiscard]] const Variant& variant(const Primitive& primitive);

  /// the scene with vertices of their own for its faces, where the shaders ask for that
  std::optional<SceneData> faceted_;
  const SceneData& scene_;
  View seen_;                        ///< of the world as it is
  std::optional<WorldRange> range_;  ///< how the world was moved, if it had to be
  std::optional<Placements> moved_;  ///< and what moved with it
  PlacedScene placed_;
  SceneOptions options_;
  View view_;
  float exposure_ = 1;
  std::shared_ptr<const EnvironmentMap> environment_;  ///< that shaders look at; null: none
  std::vector<Light> lights_;
  traces::CommandStream stream_;
  ShaderLibrary shaders_;
  std::map<TextureKey, traces::Index> textures_;
  std::set<int> images_;  ///< of `textures_`
  /// by material, available attributes, partial normals
  std::map<std::tuple<int, std::array<bool, kSemantics>, bool, traces::Topology, bool, float>, Variant>
      variants_;
  std::map<std::pair<int, std::array<bool, kTextureSlots>>, traces::Index> material_sets_;
  std::map<int, traces::Index> material_blocks_;
  /// of instances neither posed nor copied, by primitive and whether they mirror
  std::map<std::pair<std::uint32_t, bool>, States> states_;
  /// by `Instance::copies`, where their order is the scene's
  std::map<int, traces::Index> copies_buffers_;
  std::vector<traces::Index> array_buffers_;        ///< by array of the scene; kNone: not recorded
  std::map<std::string, traces::Index> pose_sets_;  ///< by the block's bytes
  /// by primitive, pose, and whether the host skins too
  std::map<std::tuple<std::uint32_t, int, bool>, PosedStreams> posed_streams_;
  /// what each slot holds, to leave out repeated binds
  std::vector<traces::Command> bound_;
  std::size_t more_shaders_ = 0;  ///< of a background and a second pass
  std::size_t posed_bytes_ = 0;   ///< by the host
  std::optional<DepthRange> depth_range_;
  std::map<std::uint32_t, Corners> corners_;                       ///< by primitive
  std::map<std::pair<std::uint32_t, int>, Array> host_positions_;  ///< by primitive and pose
  traces::Index painter_indices_ = traces::kNone;
  std::uint32_t draws_ = 0, triangles_ = 0;
};

}  // namespace quadrille::scenes
