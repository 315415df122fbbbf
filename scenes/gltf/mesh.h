/// glTF meshes as primitives over shared arrays.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Converts meshes on demand into the tables of a scene; what two primitives share is converted once.
class MeshReader {
 public:
  MeshReader(const GltfFile& file, SceneData& scene) : file_(file), scene_(scene) {}
  /// The primitives (into `SceneData::primitives`) of mesh `index`. Throws `UserError` with the place of what
  /// is wrong.
  [[nodiscard]] const std::vector<std::uint32_t>& primitives(int index);
  /// Reads the joints and weights of mesh `index`, for a skin of `joints`. Throws `UserError` when a
  /// primitive has none, or names a joint beyond.
  void read_skinning(int index, std::size_t joints, int skin);
  /// A line for each kind of values that had to be mended, and forgets them.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  /// Vertices whose values of one kind are not what the file says they are.
  struct Mended {
    std::string first_place;
    std::size_t places = 0, count = 0, of = 0;
    void add(const std::string& place, std::size_t mended, std::size_t vertices);
    [[nodiscard]] std::string text() const;
  };

  [[nodiscard]] bool read_primitive(const tinygltf::Primitive& source, const std::string& place,
                                    Primitive& primitive);
  void read_attributes(const tinygltf::Primitive& source, const std::string& place, Primitive& primitive);
  void check_directions(const std::string& place, Primitive& primitive);
  void read_targets(const tinygltf::Primitive& source, const std::string& place, Primitive& primitive);
  [[nodiscard]] const std::array<JointSet, 2>& joint_sets(const tinygltf::Primitive& source,
                                                          const std::string& place, std::size_t vertices);
  void read_joints(const tinygltf::Primitive& source, const std::string& place, Primitive& primitive,
                   std::size_t joint_count, int skin);
  [[nodiscard]] const std::vector<Bounds>& joint_boxes(int positions, const JointSet& set,
                                                       const std::string& place);
  [[nodiscard]] int delta_array(int accessor, std::size_t components, const std::string& place);
  void read_indices(const tinygltf::Primitive& source, const std::string& place, Primitive& primitive);
  void close_loop(const std::string& place, Primitive& primitive);
  [[nodiscard]] int vertex_array(int accessor, Semantic semantic, const std::string& place);
  [[nodiscard]] int index_array(int accessor, const std::string& place);
  [[nodiscard]] int material(int index, const std::string& place);
  void require_vertices(std::size_t count, std::size_t vertices, const std::string& place) const;
  [[nodiscard]] int add_array(Array array, const std::string& place);
  /// Refuses `bytes` more of streams, before anything is allocated for them, when they are too many.
  void require_room(std::uint64_t bytes, const std::string& place) const;
  [[nodiscard]] Bounds position_bounds(const Array& positions) const;

  const GltfFile& file_;
  SceneData& scene_;
  std::map<int, std::vector<std::uint32_t>> meshes_;
  std::vector<const tinygltf::Primitive*> sources_;  ///< by primitive of the scene
  std::set<int> with_joints_;                        ///< meshes whose joints have been read
  std::map<std::pair<int, std::size_t>, int> delta_arrays_;
  /// by accessors of joints and weights, set by set
  std::map<std::array<int, 4>, std::array<JointSet, 2>> joint_arrays_;
  std::map<std::pair<int, Semantic>, int> vertex_arrays_;
  std::map<int, std::pair<int, traces::IndexType>> index_arrays_;
  /// by array of normals or tangents: how many point nowhere
  std::map<int, std::uint32_t> without_direction_;
  std::map<int, std::uint32_t> largest_index_;  ///< by index array
  /// the file's number (-1: the default material) to the scene's
  std::map<int, int> materials_;
  std::map<int, Bounds> bounds_;  ///< by position array
  /// by arrays of positions, joints and weights
  std::map<std::array<int, 3>, std::vector<Bounds>> joint_boxes_;
  std::uint64_t total_bytes_ = 0;
  std::size_t jointed_vertices_ = 0, joint_box_count_ = 0;
  Mended mended_weights_, mended_normals_, dropped_tangents_;
};

}  // namespace quadrille::scenes
