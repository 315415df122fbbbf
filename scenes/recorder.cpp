#include "scenes/recorder.h"

#include <algorithm>
#include <cstring>
#include <set>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/host_pose.h"
#include "scenes/mip_chain.h"
#include "scenes/parallel.h"
#include "scenes/spirv_bindings.h"
#include "traces/trace_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxPosedBytes = std::size_t{3} << 28;  // 768 MiB
static_assert(offsetof(DrawConstants, draw_id) == 112 && offsetof(DrawConstants, handedness) + 4 == kDrawConstantBytes);

/// `Material` of scenes/shaders/material.glsl, std140.
struct MaterialBlock {
  glm::vec4 base_color, emissive, factors;
  std::array<glm::vec4, 2 * kBaseTextureSlots> uv_rows;
};

/// What follows it where the material has layers.
struct LayerBlock {
  glm::vec4 specular, clearcoat, sheen, transmission;
  std::array<glm::vec4, 2 * (kTextureSlots - kBaseTextureSlots)> uv_rows;
};

MaterialBlock material_values(const Material& m) {
  MaterialBlock block{
      m.base_color, glm::vec4(m.emissive, m.alpha_cutoff), {m.metallic, m.roughness, m.normal_scale, m.occlusion_strength}, {}};
  for (std::size_t slot = 0; slot < kBaseTextureSlots; ++slot) {
    block.uv_rows[2 * slot] = glm::vec4(m.textures[slot].u_row, 0);
    block.uv_rows[2 * slot + 1] = glm::vec4(m.textures[slot].v_row, 0);
  }
  return block;
}

LayerBlock layer_values(const Material& m) {
  const MaterialLayers& l = m.layers;
  LayerBlock block{glm::vec4(l.specular_color, l.specular_weight),
                   glm::vec4(l.clearcoat, l.clearcoat_roughness, l.clearcoat_normal_scale, 0),
                   glm::vec4(l.sheen_color, l.sheen_roughness),
                   glm::vec4(l.absorption, l.transmission),
                   {}};
  for (std::size_t slot = kBaseTextureSlots; slot < kTextureSlots; ++slot) {
    const std::size_t row = 2 * (slot - kBaseTextureSlots);
    block.uv_rows[row] = glm::vec4(m.textures[slot].u_row, 0);
    block.uv_rows[row + 1] = glm::vec4(m.textures[slot].v_row, 0);
  }
  return block;
}

template <class T>
std::vector<std::byte> bytes_of(const T& value, std::size_t size = sizeof(T)) {
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), &value, size);
  return bytes;
}

bool is_srgb(std::size_t slot) {
  const auto role = static_cast<TextureSlot>(slot);
  return role == TextureSlot::kBaseColor || role == TextureSlot::kEmissive || role == TextureSlot::kSpecularColor ||
         role == TextureSlot::kSheenColor;
}

const traces::BlendState kOver{true,
                               traces::BlendFactor::kSrcAlpha,
                               traces::BlendFactor::kOneMinusSrcAlpha,
                               traces::BlendFactor::kOne,
                               traces::BlendFactor::kOneMinusSrcAlpha,
                               traces::BlendOp::kAdd,
                               traces::BlendOp::kAdd,
                               0xf};

/// The colour comes multiplied by how much of what lies behind it hides.
const traces::BlendState kPremultiplied{true,
                                        traces::BlendFactor::kOne,
                                        traces::BlendFactor::kOneMinusSrcAlpha,
                                        traces::BlendFactor::kOne,
                                        traces::BlendFactor::kOneMinusSrcAlpha,
                                        traces::BlendOp::kAdd,
                                        traces::BlendOp::kAdd,
                                        0xf};

}  // namespace

bool mirrors(const glm::mat4& world) { return glm::determinant(glm::dmat3(glm::mat3(world))) < 0; }

// By cofactors: the same direction, and defined for a singular matrix too (a flattened mesh keeps its normals). With the longest column one long, squares in
// the shader neither vanish nor overflow.
std::array<glm::vec4, 3> normal_matrix(const glm::mat4& world, bool mirrored) {
  const glm::dvec3 x(world[0]), y(world[1]), z(world[2]);
  std::array<glm::dvec3, 3> columns{glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
  const double longest = std::max({glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2])});
  const double scale = (mirrored ? -1.0 : 1.0) / (longest > 0 ? longest : 1.0);
  return {glm::vec4(columns[0] * scale, 0), glm::vec4(columns[1] * scale, 0), glm::vec4(columns[2] * scale, 0)};
}

Recorder::Recorder(const SceneData& scene, const SceneOptions& options)
    : range_(needed_range(scene, options)),
      moved_(range_ ? std::optional(moved(scene, *range_)) : std::nullopt),
      scene_(moved_ ? *moved_ : scene),
      options_(range_ ? moved(options, *range_) : options),
      view_(make_view(scene_, options_)),
      lights_(frame_lights(scene_, view_)),
      shaders_(options, frame_defines(view_, lights_), stream_.shaders),
      bound_(kVertexSlot + kLocations, traces::EndPass{}) {}

traces::CommandStream Recorder::record() {
  stream_.name = scene_.name;
  stream_.targets.push_back({options_.width, options_.height,
                             options_.visibility ? traces::Format::kR8G8B8A8Unorm : traces::Format::kR8G8B8A8Srgb,
                             scene_.depth ? traces::Format::kD32Float : traces::Format::kUndefined});
  record_arrays();
  record_textures();
  const glm::vec3& back = scene_.background;
  const std::array<float, 4> clear =
      options_.visibility ? std::array<float, 4>{0, 0, 0, 0} : std::array<float, 4>{back.r, back.g, back.b, 1};
  stream_.commands.emplace_back(traces::BeginPass{0, clear, 1});
  stream_.commands.emplace_back(traces::SetViewport{0, 0, static_cast<float>(options_.width), static_cast<float>(options_.height), 0, 1});
  stream_.commands.emplace_back(traces::SetScissor{0, 0, options_.width, options_.height});
  record_frame_set();
  for (const std::size_t i : draw_order()) record_instance(scene_.instances[i]);
  stream_.commands.emplace_back(traces::EndPass{});
  return std::move(stream_);
}

std::vector<std::size_t> Recorder::draw_order() const {
  std::vector<std::size_t> order;
  std::vector<std::pair<float, std::size_t>> blended;  // distance along the view direction, instance
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const Primitive& primitive = scene_.primitives[scene_.instances[i].primitive];
    if (!scene_.materials[static_cast<std::size_t>(primitive.material)].see_through()) {
      order.push_back(i);
      continue;
    }
    const Bounds box = scene_.box(scene_.instances[i]);
    blended.emplace_back(box.empty() ? 0.0F : glm::dot(view_.eye - box.center(), view_.toward_viewer), i);
  }
  std::ranges::stable_sort(blended, std::ranges::greater{}, &std::pair<float, std::size_t>::first);
  for (const auto& [distance, i] : blended) order.push_back(i);
  return order;
}

void Recorder::record_arrays() {
  std::vector<bool> deltas(scene_.arrays.size());
  for (const Primitive& primitive : scene_.primitives) {
    for (const MorphTarget& target : primitive.targets) {
      for (const int array : target.deltas) {
        if (array >= 0) deltas[static_cast<std::size_t>(array)] = true;
      }
    }
  }
  array_buffers_.assign(scene_.arrays.size(), traces::kNone);
  for (std::size_t i = 0; i < scene_.arrays.size(); ++i) {
    if (!deltas[i]) (void)array_buffer(static_cast<int>(i));  // of morph targets, those with weight are recorded when a draw reads them
  }
}

traces::Index Recorder::array_buffer(int array) {
  traces::Index& buffer = array_buffers_[static_cast<std::size_t>(array)];
  if (buffer == traces::kNone) {
    buffer = static_cast<traces::Index>(stream_.buffers.size());
    stream_.buffers.push_back({scene_.arrays[static_cast<std::size_t>(array)].name, scene_.arrays[static_cast<std::size_t>(array)].data});
  }
  return buffer;
}

traces::Index Recorder::pose_set(const std::vector<std::byte>& block) {
  const auto [entry, added] = pose_sets_.try_emplace({reinterpret_cast<const char*>(block.data()), block.size()},
                                                     static_cast<traces::Index>(stream_.descriptor_sets.size()));
  if (!added) return entry->second;
  const auto buffer = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"pose", block});
  stream_.descriptor_sets.push_back({{{0, buffer, 0, static_cast<std::uint32_t>(block.size())}}, {}});
  return entry->second;
}

void Recorder::add_stream(Geometry& geometry, std::uint32_t location, const Array& array, traces::Index buffer) {
  geometry.streams.emplace_back(location, buffer);
  geometry.formats.push_back(array.format);
}

Recorder::Geometry Recorder::geometry(const Instance& instance) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  Geometry g;
  g.variant = variant(primitive);
  g.mirrored = mirrors(instance.copies < 0 ? instance.world : scene_.copies[static_cast<std::size_t>(instance.copies)].front());
  for (std::uint32_t i = 0; i < kSemantics; ++i) {
    if (!g.variant.attributes[i]) continue;
    add_stream(g, i, scene_.arrays[static_cast<std::size_t>(primitive.attributes[i])], array_buffer(primitive.attributes[i]));
  }
  if (instance.pose >= 0) pose(instance, g);
  return g;
}

/// Adds what the shader poses with, or puts what the host has posed in the place of the mesh's own streams.
void Recorder::pose(const Instance& instance, Geometry& g) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  const Pose& pose = scene_.poses[static_cast<std::size_t>(instance.pose)];
  const bool on_host = !options_.vertex_shader.empty() || instance.copies >= 0;  // copies have their matrices where a pose has its streams
  g.mirrored = g.mirrored != pose.mirrored;
  PoseStreams plan = choose_pose_streams(primitive, pose, g.variant.attributes, on_host);
  g.variant.pose_defines = std::move(plan.defines);
  for (const PoseStream& s : plan.streams)
    add_stream(g, s.location, scene_.arrays[static_cast<std::size_t>(s.array)], array_buffer(s.array));
  if (!plan.block.empty()) g.pose_set = pose_set(plan.block);
  if (!plan.morph_on_host && !plan.skin_on_host) return;
  const auto posed = pose_on_host(scene_, primitive, pose, plan.skin_on_host);
  for (std::size_t i = 0; i < g.streams.size(); ++i) {
    const std::uint32_t location = g.streams[i].first;
    if (location >= kSemantics || !posed[location]) continue;
    g.streams[i].second = static_cast<traces::Index>(stream_.buffers.size());
    g.formats[i] = posed[location]->format;
    posed_bytes_ += posed[location]->data.size();
    if (posed_bytes_ > kMaxPosedBytes)
      throw user_error("{}: vertices posed by the host take more than {} bytes", scene_.name, kMaxPosedBytes);
    stream_.buffers.push_back({posed[location]->name, posed[location]->data});
  }
}

const Variant& Recorder::variant(const Primitive& primitive) {
  std::array<bool, kSemantics> available{};
  for (std::size_t i = 0; i < kSemantics; ++i) available[i] = primitive.attributes[i] >= 0;
  const auto [entry, added] = variants_.try_emplace({primitive.material, available});
  if (added) {
    entry->second = choose_variant(scene_.materials[static_cast<std::size_t>(primitive.material)], primitive, shaders_.set());
    if (shaders_.set() == ShaderSet::kUser && options_.leave_out) leave_out_unread(entry->second);
  }
  return entry->second;
}

/// A shader of the user's is offered every texture of a material; most look at few.
void Recorder::leave_out_unread(Variant& v) {
  std::set<std::uint32_t> read;
  for (const traces::Index shader : {shaders_.vertex(v), shaders_.fragment(v)})
    read.merge(mentioned_bindings(stream_.shaders[shader].spirv, kMaterialSet));
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot)
    v.textures[slot] = v.textures[slot] && read.contains(static_cast<std::uint32_t>(1 + slot));
}

void Recorder::add_textures(const std::vector<TextureKey>& keys) {
  std::set<int> sources;
  for (const TextureKey& key : keys) sources.insert(key.image);
  const std::vector<int> packed(sources.begin(), sources.end());
  parallel_for(packed.size(), [&](std::size_t i) { (void)scene_.images[static_cast<std::size_t>(packed[i])].pixels(); });
  const std::size_t first = stream_.images.size();
  stream_.images.resize(first + keys.size());
  parallel_for(keys.size(), [&](std::size_t i) {
    const SceneImage& source = scene_.images[static_cast<std::size_t>(keys[i].image)];
    const Rgba8Image& image = source.pixels();
    stream_.images[first + i] = {source.name(),
                                 keys[i].srgb ? traces::Format::kR8G8B8A8Srgb : traces::Format::kR8G8B8A8Unorm,
                                 image.width,
                                 image.height,
                                 full_chain_levels(image.width, image.height),
                                 build_mip_chain(image, keys[i].srgb)};
  });
}

void Recorder::record_textures() {
  std::set<TextureKey> used;
  for (const Instance& instance : scene_.instances) {
    const Primitive& primitive = scene_.primitives[instance.primitive];
    const Variant& v = variant(primitive);
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
      if (v.textures[slot])
        used.insert({scene_.materials[static_cast<std::size_t>(primitive.material)].textures[slot].image, is_srgb(slot)});
    }
  }
  const std::vector<TextureKey> keys(used.begin(), used.end());
  add_textures(keys);
  for (std::size_t i = 0; i < keys.size(); ++i) textures_[keys[i]] = static_cast<traces::Index>(i);
  if (options_.leave_out) return;
  std::vector<TextureKey> unread;
  for (int i = 0; i < static_cast<int>(scene_.images.size()); ++i) {
    if (!used.contains({i, false}) && !used.contains({i, true})) unread.push_back({i, false});
  }
  add_textures(unread);
}

void Recorder::record_frame_set() {
  const auto block = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"frame", frame_block(scene_, view_, lights_)});
  const auto set = static_cast<traces::Index>(stream_.descriptor_sets.size());
  stream_.descriptor_sets.push_back({{{0, block, 0, static_cast<std::uint32_t>(stream_.buffers.back().data.size())}}, {}});
  stream_.commands.emplace_back(traces::BindDescriptorSet{kFrameSet, set});
}

traces::Index Recorder::sampler(const traces::Sampler& wanted) {
  const auto found = std::ranges::find(stream_.samplers, wanted);
  if (found == stream_.samplers.end()) {
    stream_.samplers.push_back(wanted);
    return static_cast<traces::Index>(stream_.samplers.size() - 1);
  }
  return static_cast<traces::Index>(found - stream_.samplers.begin());
}

traces::Index Recorder::material_block(int material) {
  const auto [entry, added] = material_blocks_.try_emplace(material, static_cast<traces::Index>(stream_.buffers.size()));
  if (added) {
    const Material& m = scene_.materials[static_cast<std::size_t>(material)];
    std::vector<std::byte> block = bytes_of(material_values(m));
    const std::vector<std::byte> layers = m.layers.any() ? bytes_of(layer_values(m)) : std::vector<std::byte>();
    block.insert(block.end(), layers.begin(), layers.end());
    stream_.buffers.push_back({"material " + m.name, std::move(block)});
  }
  return entry->second;
}

traces::Index Recorder::material_set(int material, const Variant& v) {
  const auto [entry, added] =
      material_sets_.try_emplace({material, v.textures}, static_cast<traces::Index>(stream_.descriptor_sets.size()));
  if (!added) return entry->second;
  const traces::Index block = material_block(material);
  traces::DescriptorSet set{{{0, block, 0, static_cast<std::uint32_t>(stream_.buffers[block].data.size())}}, {}};
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    if (!v.textures[slot]) continue;
    const TextureUse& use = scene_.materials[static_cast<std::size_t>(material)].textures[slot];
    set.textures.push_back({static_cast<std::uint32_t>(1 + slot), textures_.at({use.image, is_srgb(slot)}), sampler(use.sampler)});
  }
  stream_.descriptor_sets.push_back(std::move(set));
  return entry->second;
}

namespace {

/// Three rows of the model matrix, then three columns of the normal matrix, 16 bytes each.
void add_copy_streams(traces::Pipeline& p) {
  constexpr std::uint32_t kVectorBytes = 16;
  p.bindings.push_back({kCopiesBinding, 6 * kVectorBytes, true});
  for (std::uint32_t i = 0; i < 6; ++i)
    p.attributes.push_back({kCopiesBinding + i, kCopiesBinding,
                            i < 3 ? traces::Format::kR32G32B32A32Float : traces::Format::kR32G32B32Float, i * kVectorBytes});
}

}  // namespace

traces::Index Recorder::pipeline(const Primitive& primitive, const Material& material, const Geometry& g) {
  traces::Pipeline p;
  p.vertex_shader = shaders_.vertex(g.variant);
  p.fragment_shader = shaders_.fragment(g.variant);
  for (std::size_t i = 0; i < g.streams.size(); ++i) {
    p.bindings.push_back({g.streams[i].first, traces::format_bytes(g.formats[i]), false});
    p.attributes.push_back({g.streams[i].first, g.streams[i].first, g.formats[i], 0});
  }
  if (g.variant.instanced) add_copy_streams(p);
  const bool blended = material.see_through() && !options_.visibility;
  p.topology = primitive.topology;
  p.cull = material.double_sided ? traces::CullMode::kNone : traces::CullMode::kBack;
  p.front = g.mirrored ? traces::FrontFace::kClockwise : traces::FrontFace::kCounterClockwise;
  p.depth = {scene_.depth, scene_.depth && (!blended || material.alpha != AlphaMode::kBlend), traces::CompareOp::kLess};
  if (blended) p.blend = material.layers.transmits() ? kPremultiplied : kOver;
  const auto found = std::ranges::find_if(stream_.pipelines, [&](traces::Pipeline other) { return other.name = p.name, other == p; });
  if (found != stream_.pipelines.end()) return static_cast<traces::Index>(found - stream_.pipelines.begin());
  p.name = "pipeline " + std::to_string(stream_.pipelines.size());
  stream_.pipelines.push_back(std::move(p));
  return static_cast<traces::Index>(stream_.pipelines.size() - 1);
}

void Recorder::bind_once(const traces::Command& command, std::size_t slot) {
  if (bound_[slot] == command) return;
  bound_[slot] = command;
  stream_.commands.push_back(command);
}

void Recorder::bind_geometry(const Primitive& primitive, const Geometry& g) {
  if (g.pose_set != traces::kNone) bind_once(traces::BindDescriptorSet{kPoseSet, g.pose_set}, kPoseSlot);
  for (const auto& [location, buffer] : g.streams) bind_once(traces::BindVertexBuffer{location, buffer, 0}, kVertexSlot + location);
  if (primitive.indices >= 0) bind_once(traces::BindIndexBuffer{array_buffer(primitive.indices), 0, primitive.index_type}, kIndexSlot);
}

void Recorder::push_constants(const Instance& instance, bool mirrored) {
  const DrawConstants constants{instance.world, normal_matrix(instance.world, mirrored), draws_, triangles_, mirrored ? -1.0F : 1.0F};
  stream_.commands.emplace_back(traces::PushConstants{0, bytes_of(constants, kDrawConstantBytes)});
}

void Recorder::record_instance(const Instance& instance) {
  if (instance.copies >= 0) return record_copies(instance);
  const Primitive& primitive = scene_.primitives[instance.primitive];
  const Geometry g = geometry(instance);
  bind_once(traces::BindPipeline{pipeline(primitive, scene_.materials[static_cast<std::size_t>(primitive.material)], g)}, kPipelineSlot);
  bind_once(traces::BindDescriptorSet{kMaterialSet, material_set(primitive.material, g.variant)}, kSetSlot);
  bind_geometry(primitive, g);
  push_constants(instance, g.mirrored);
  stream_.commands.emplace_back(traces::Draw{primitive.indices >= 0, primitive.count, 0, 0, 1, 0, instance.label});
  ++draws_;
  triangles_ += traces::triangle_count(primitive.topology, primitive.count);
}

}  // namespace quadrille::scenes
