#include "scenes/record/recorder.h"

#include <algorithm>
#include <cstring>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "models/geometry/assembly.h"
#include "scenes/material/shader_sources.h"
#include "scenes/record/facets.h"
#include "scenes/record/host_pose.h"
#include "scenes/record/post_pass.h"
#include "scenes/view/exposure.h"
#include "traces/trace_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxPosedBytes = std::size_t{3} << 28;  // 768 MiB
static_assert(offsetof(DrawConstants, draw_id) == 112 &&
              offsetof(DrawConstants, handedness) + 4 == kDrawConstantBytes);

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

/// Colours are sums.
const traces::BlendState kSum{true,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kZero,
                              traces::BlendOp::kAdd,
                              traces::BlendOp::kAdd,
                              0xf};

/// Are see-through materials drawn like others? A number that a pixel shows is not to be blended. Overdraw is
/// that of the frame with its colours.
bool draws_solid(const SceneOptions& options, ShaderSet set) {
  return options.visibility || set == ShaderSet::kMinimal ||
         (shows_values(set) && set != ShaderSet::kOverdraw);
}

/// How a material's fragments meet what the target holds.
traces::BlendState blend_of(const Material& material, ShaderSet set) {
  if (set == ShaderSet::kOverdraw) return kSum;
  if (lights_by_phong(set)) return material.alpha == AlphaMode::kBlend ? kOver : traces::BlendState{};
  if (!material.see_through()) return {};
  return material.layers.transmits() ? kPremultiplied : kOver;
}

}  // namespace

bool mirrors(const glm::mat4& world) { return glm::determinant(glm::dmat3(glm::mat3(world))) < 0; }

// By cofactors: the same direction, and defined for a singular matrix too (a flattened mesh keeps its
// normals). With the longest column one long, squares in the shader neither vanish nor overflow.
std::array<glm::vec4, 3> normal_matrix(const glm::mat4& world, bool mirrored) {
  const glm::dvec3 x(world[0]), y(world[1]), z(world[2]);
  std::array<glm::dvec3, 3> columns{glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
  const double longest =
      std::max({glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2])});
  const double scale = (mirrored ? -1.0 : 1.0) / (longest > 0 ? longest : 1.0);
  return {glm::vec4(columns[0] * scale, 0), glm::vec4(columns[1] * scale, 0),
          glm::vec4(columns[2] * scale, 0)};
}

// The camera frames the scene as it came, so that shadings are seen from one place.
Recorder::Recorder(const SceneData& scene, const SceneOptions& options)
    : faceted_(with_facets(scene, shader_set(options))),
      scene_(faceted_ ? *faceted_ : scene),
      seen_(make_view(scene, options)),
      range_(needed_range(PlacedScene(scene), seen_)),
      moved_(range_ ? std::optional(moved(static_cast<const Placements&>(scene_), *range_)) : std::nullopt),
      placed_(moved_ ? PlacedScene(scene_, *moved_) : PlacedScene(scene_)),
      options_(range_ ? moved(options, *range_) : options),
      view_(range_ ? make_view(PlacedScene(scene, moved(static_cast<const Placements&>(scene), *range_)),
                               options_)
                   : seen_),
      exposure_(scenes::exposure(placed_, options_)),
      environment_(shader_set(options) == ShaderSet::kMaterial ? scene.environment.map : nullptr),
      lights_(frame_lights(placed_, view_, exposure_, environment_.get())),
      shaders_(options, frame_defines(view_, lights_, environment_.get()), stream_.shaders),
      bound_(kVertexSlot + kLocations, traces::EndPass{}) {}

traces::CommandStream Recorder::record() {
  stream_.name = scene_.name;
  record_arrays();
  record_textures();
  const glm::vec3& back = scene_.background;
  const bool values = options_.visibility || shows_values(shaders_.set());
  const std::array<float, 4> clear = values ? std::array<float, 4>{0, 0, 0, options_.visibility ? 0.0F : 1.0F}
                                            : std::array<float, 4>{back.r, back.g, back.b, 1};
  const std::size_t begin = stream_.commands.size();
  stream_.commands.emplace_back(traces::make_pass(
      stream_,
      {options_.width, options_.height, values ? traces::Format::kR8G8B8A8Unorm : options_.color_format,
       has_depth() ? options_.depth_format : traces::Format::kUndefined},
      clear));
  stream_.commands.emplace_back(traces::SetViewport{0, 0, static_cast<float>(options_.width),
                                                    static_cast<float>(options_.height), 0, 1});
  stream_.commands.emplace_back(traces::SetScissor{0, 0, options_.width, options_.height});
  if (shaders_.set() == ShaderSet::kDepth) depth_range_ = find_depth_range();
  record_frame_set();
  record_draws();
  stream_.commands.emplace_back(traces::EndPass{});
  keep_fragments(begin);
  add_second_pass();
  return std::move(stream_);
}

/// The background comes where depths keep it behind what is opaque and before what is seen through.
void Recorder::record_draws() {
  bool background = environment_ != nullptr && environment_->shown;
  const auto draw_background = [&] {
    if (std::exchange(background, false)) record_background();
  };
  if (!has_depth()) draw_background();
  if (options_.order == DrawOrder::kPainter) return record_as_painter();
  for (const std::size_t i : draw_order()) {
    const Instance& instance = placed_.at.instances[i];
    const int material = scene_.primitives[instance.primitive].material;
    if (scene_.materials[static_cast<std::size_t>(material)].see_through()) draw_background();
    record_instance(instance);
  }
  draw_background();
}

/// A scene's own needs the depths, and colours to work with.
void Recorder::add_second_pass() {
  const bool overdraw = shaders_.set() == ShaderSet::kOverdraw;
  const bool own = !options_.visibility && !shows_values(shaders_.set()) && has_depth() == scene_.depth;
  const std::string shader(overdraw ? std::string(kOverdrawFrag) : own ? scene_.post_shader : "");
  if (shader.empty()) return;
  add_post_pass(stream_, shader);
  more_shaders_ += 2;
}

bool Recorder::order_independent(const Material& material) const {
  return options_.transparency.mode != traces::Transparency::kNone && material.see_through() &&
         !draws_solid(options_, shaders_.set()) && models::is_over(blend_of(material, shaders_.set()));
}

void Recorder::keep_fragments(std::size_t begin) {
  if (std::ranges::any_of(stream_.pipelines, &traces::Pipeline::order_independent))
    std::get<traces::BeginPass>(stream_.commands[begin]).transparency = options_.transparency;
}

std::vector<std::size_t> Recorder::draw_order() const {
  std::vector<std::size_t> order, independent;
  std::vector<std::pair<float, std::size_t>> blended;  // distance along the view direction, instance
  for (std::size_t i = 0; i < placed_.at.instances.size(); ++i) {
    const Primitive& primitive = scene_.primitives[placed_.at.instances[i].primitive];
    const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
    if (!material.see_through() || order_independent(material)) {
      (material.see_through() ? independent : order).push_back(i);
      continue;
    }
    const Bounds box = placed_.box(placed_.at.instances[i]);
    blended.emplace_back(box.empty() ? 0.0F : glm::dot(view_.eye - box.center(), view_.toward_viewer), i);
  }
  std::ranges::stable_sort(blended, std::ranges::greater{}, &std::pair<float, std::size_t>::first);
  for (const auto& [distance, i] : blended) order.push_back(i);
  order.insert(order.end(), independent.begin(), independent.end());
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
    // of morph targets, those with weight are recorded when a draw reads them
    if (!deltas[i]) (void)array_buffer(static_cast<int>(i));
  }
}

traces::Index Recorder::array_buffer(int array) {
  traces::Index& buffer = array_buffers_[static_cast<std::size_t>(array)];
  if (buffer == traces::kNone) {
    buffer = static_cast<traces::Index>(stream_.buffers.size());
    stream_.buffers.push_back({scene_.arrays[static_cast<std::size_t>(array)].name,
                               scene_.arrays[static_cast<std::size_t>(array)].data});
  }
  return buffer;
}

traces::Index Recorder::pose_set(const std::vector<std::byte>& block) {
  const auto [entry, added] =
      pose_sets_.try_emplace({reinterpret_cast<const char*>(block.data()), block.size()},
                             static_cast<traces::Index>(stream_.descriptor_sets.size()));
  if (!added) return entry->second;
  const auto buffer = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"pose", block});
  stream_.descriptor_sets.push_back({{{0, buffer, 0, static_cast<std::uint32_t>(block.size())}}, {}});
  return entry->second;
}

void Recorder::add_stream(Geometry& geometry, std::uint32_t location, const Array& array,
                          traces::Index buffer) {
  geometry.streams.emplace_back(location, buffer);
  geometry.formats.push_back(array.format);
}

Recorder::Geometry Recorder::geometry(const Instance& instance) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  Geometry g;
  g.variant = variant(primitive);
  g.mirrored = mirrors(glm::mat4(instance.copies < 0
                                     ? instance.world
                                     : placed_.at.copies[static_cast<std::size_t>(instance.copies)].front()));
  for (std::uint32_t i = 0; i < kSemantics; ++i) {
    if (!g.variant.attributes[i]) continue;
    add_stream(g, i, scene_.arrays[static_cast<std::size_t>(primitive.attributes[i])],
               array_buffer(primitive.attributes[i]));
  }
  if (instance.pose >= 0) pose(instance, g);
  return g;
}

/// Adds what the shader poses with, or puts what the host has posed in the place of the mesh's own streams.
void Recorder::pose(const Instance& instance, Geometry& g) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  const Pose& pose = scene_.poses[static_cast<std::size_t>(instance.pose)];
  // copies have their matrices where a pose has its streams
  const bool on_host = !options_.vertex_shader.empty() || instance.copies >= 0;
  g.mirrored = g.mirrored != pose.mirrored;
  PoseStreams plan = choose_pose_streams(primitive, pose, g.variant.attributes, on_host);
  g.variant.pose_defines = std::move(plan.defines);
  for (const PoseStream& s : plan.streams)
    add_stream(g, s.location, scene_.arrays[static_cast<std::size_t>(s.array)], array_buffer(s.array));
  if (!plan.block.empty()) g.pose_set = pose_set(plan.block);
  if (!plan.morph_on_host && !plan.skin_on_host) return;
  const PosedStreams& posed = posed_streams(instance, plan.skin_on_host);
  for (std::size_t i = 0; i < g.streams.size(); ++i) {
    const std::uint32_t location = g.streams[i].first;
    if (location >= kSemantics || posed[location].second == traces::kNone) continue;
    g.formats[i] = posed[location].first;
    g.streams[i].second = posed[location].second;
  }
}

const Recorder::PosedStreams& Recorder::posed_streams(const Instance& instance, bool skinned) {
  const auto [entry, added] = posed_streams_.try_emplace({instance.primitive, instance.pose, skinned});
  if (!added) return entry->second;
  const auto arrays = pose_on_host(scene_, scene_.primitives[instance.primitive],
                                   scene_.poses[static_cast<std::size_t>(instance.pose)], skinned);
  const Variant& read = variant(scene_.primitives[instance.primitive]);
  for (std::size_t i = 0; i < kSemantics; ++i) {
    entry->second[i].second = traces::kNone;
    if (!read.attributes[i] || !arrays[i]) continue;
    posed_bytes_ += arrays[i]->data.size();
    if (posed_bytes_ > kMaxPosedBytes)
      throw user_error("{}: vertices posed by the host take more than {} bytes", scene_.name, kMaxPosedBytes);
    entry->second[i] = {arrays[i]->format, static_cast<traces::Index>(stream_.buffers.size())};
    stream_.buffers.push_back({arrays[i]->name, arrays[i]->data});
  }
  return entry->second;
}

void Recorder::record_frame_set() {
  const auto block = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"frame", frame_block(scene_, view_, lights_, exposure_, depth_range_)});
  const auto set = static_cast<traces::Index>(stream_.descriptor_sets.size());
  stream_.descriptor_sets.push_back(
      {{{0, block, 0, static_cast<std::uint32_t>(stream_.buffers.back().data.size())}}, {}});
  if (environment_ != nullptr) add_environment(stream_.descriptor_sets.back());
  stream_.commands.emplace_back(traces::BindDescriptorSet{kFrameSet, set});
}

namespace {

/// Three rows of the model matrix, then three columns of the normal matrix, 16 bytes each.
void add_copy_streams(traces::Pipeline& p) {
  constexpr std::uint32_t kVectorBytes = 16;
  p.bindings.push_back({kCopiesBinding, 6 * kVectorBytes, true});
  for (std::uint32_t i = 0; i < 6; ++i)
    p.attributes.push_back({kCopiesBinding + i, kCopiesBinding,
                            i < 3 ? traces::Format::kR32G32B32A32Float : traces::Format::kR32G32B32Float,
                            i * kVectorBytes});
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
  const bool solid = draws_solid(options_, shaders_.set()), blended = material.see_through() && !solid;
  p.topology = g.listed ? list_of(primitive.topology) : primitive.topology;
  p.primitive_restart = primitive.restarts && !g.listed;
  p.polygon_mode = primitive.style.polygon_mode;
  p.line_mode = primitive.style.line_mode;
  const bool whole_pixels = solid || shaders_.set() == ShaderSet::kOverdraw;
  if (whole_pixels && p.line_mode == traces::LineMode::kSmooth) p.line_mode = traces::LineMode::kRectangular;
  p.line_width = primitive.style.line_width;
  p.alpha_to_coverage = options_.alpha_to_coverage && covers_by_alpha(material, shaders_.set());
  p.cull = material.double_sided ? traces::CullMode::kNone : traces::CullMode::kBack;
  p.front = g.mirrored ? traces::FrontFace::kClockwise : traces::FrontFace::kCounterClockwise;
  p.order_independent = order_independent(material);
  const bool writes_depth = !p.order_independent && (!blended || material.alpha != AlphaMode::kBlend);
  p.depth = {has_depth(), has_depth() && writes_depth, traces::CompareOp::kLess};
  if (!solid) p.blend[0] = blend_of(material, shaders_.set());
  if (!p.blend[0].enable && p.line_mode == traces::LineMode::kSmooth) p.blend[0] = kOver;
  const auto found = std::ranges::find_if(
      stream_.pipelines, [&](traces::Pipeline other) { return other.name = p.name, other == p; });
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
  for (const auto& [location, buffer] : g.streams)
    bind_once(traces::BindVertexBuffer{location, buffer, 0}, kVertexSlot + location);
  if (g.listed)
    bind_once(traces::BindIndexBuffer{painter_indices_, 0, traces::IndexType::kUint32}, kIndexSlot);
  else if (primitive.indices >= 0)
    bind_once(traces::BindIndexBuffer{array_buffer(primitive.indices), 0, primitive.index_type}, kIndexSlot);
}

void Recorder::push_constants(const glm::mat4& world, bool mirrored) {
  const DrawConstants constants{world, normal_matrix(world, mirrored), draws_, triangles_,
                                mirrored ? -1.0F : 1.0F};
  std::vector<std::byte> bytes(kDrawConstantBytes);
  std::memcpy(bytes.data(), &constants, bytes.size());
  stream_.commands.emplace_back(traces::PushConstants{0, std::move(bytes)});
}

void Recorder::record_instance(const Instance& instance) {
  if (instance.copies >= 0) return record_copies(instance, geometry(instance));
  if (instance.pose >= 0) {
    const Geometry g = geometry(instance);
    bind(instance, g);
    return record_draw(instance, g, glm::mat4(instance.world), 1);
  }
  const glm::mat4 world(instance.world);
  const auto [entry, added] = states_.try_emplace({instance.primitive, mirrors(world)});
  if (added) entry->second = states(instance, geometry(instance));
  bind(scene_.primitives[instance.primitive], entry->second);
  record_draw(instance, entry->second.geometry, world, 1);
}

Recorder::States Recorder::states(const Instance& instance, Geometry g) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  States s;
  s.pipeline = pipeline(primitive, scene_.materials[static_cast<std::size_t>(primitive.material)], g);
  s.material_set = material_set(primitive.material, g.variant);
  s.geometry = std::move(g);
  return s;
}

void Recorder::bind(const Primitive& primitive, const States& states) {
  bind_once(traces::BindPipeline{states.pipeline}, kPipelineSlot);
  bind_once(traces::BindDescriptorSet{kMaterialSet, states.material_set}, kSetSlot);
  bind_geometry(primitive, states.geometry);
}

void Recorder::record_draw(const Instance& instance, const Geometry& g, const glm::mat4& world,
                           std::uint32_t copies) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  push_constants(world, g.mirrored);
  stream_.commands.emplace_back(
      traces::Draw{primitive.indices >= 0, primitive.count, 0, 0, copies, 0, instance.label});
  ++draws_;
  triangles_ += models::primitive_count(primitive.topology, primitive.count) * copies;
}

}  // namespace quadrille::scenes
