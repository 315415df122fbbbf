/// The command stream: everything a frame needs, at the level of Vulkan's objects, and nothing of where it
/// came from.
///
/// Objects (buffers, images, samplers, shaders, pipelines, descriptor sets) live in tables
/// and are named by their index; commands refer to them. A scene is turned into a `CommandStream`, a trace
/// file holds one, the machine, the reference renderer and the Vulkan comparison execute one. Conventions are
/// Vulkan's: clip space 0 <= z <= w, y down, column-major matrices, std140 uniform blocks, counter-clockwise
/// as stated by the pipeline.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "models/base/attachment.h"
#include "models/base/format.h"
#include "models/base/image_view.h"
#include "models/base/pipeline_state.h"
#include "models/base/sampler.h"
#include "traces/queries.h"

namespace quadrille::traces {

using Index = std::uint32_t;                 ///< into one of the tables of `CommandStream`
inline constexpr Index kNone = 0xffffffffu;  ///< an index that names nothing

using models::BlendFactor;
using models::BlendOp;
using models::BlendShared;
using models::BlendState;
using models::BorderColor;
using models::CompareOp;
using models::CullMode;
using models::DepthBias;
using models::DepthBoundsTest;
using models::Filter;
using models::Format;
using models::format_bytes;
using models::format_components;
using models::FrontFace;
using models::ImageKind;
using models::is_integer_format;
using models::kLastFormat;
using models::kMaxColorAttachments;
using models::LineMode;
using models::LoadOp;
using models::LogicOp;
using models::number_kind;
using models::NumberKind;
using models::PolygonMode;
using models::ShaderStage;
using models::StencilFace;
using models::StencilOp;
using models::StencilState;
using models::StoreOp;
using models::Topology;
using models::Transparency;
using models::TransparencyState;
using models::ViewKind;
using models::Wrap;
using Sampler = models::SamplerState;

struct Buffer {
  std::string name;
  std::vector<std::byte> data;
  friend bool operator==(const Buffer&, const Buffer&) = default;
};

/// Takes the texels of one mip level, as in `Image::texels`. They are gone after the call.
using LevelSink = std::function<void(std::uint32_t level, std::span<const std::byte> texels)>;
/// Makes all levels of an image, finest first, and hands each to the sink. Throws `UserError`. Any number of
/// times.
using UnpackTexels = std::function<void(const LevelSink&)>;

/// What an image is for, as bits.
enum ImageUsage : std::uint8_t { kSampled = 1, kColorAttachment = 2, kDepthAttachment = 4 };
inline constexpr std::uint8_t kAllUsages = kSampled | kColorAttachment | kDepthAttachment;

/// An image. One that is never an attachment is a texture and brings its texels: all mip levels, finest
/// first, in each level layer by layer or slice by slice, rows top to bottom, tightly packed; of compressed
/// formats rows of blocks, of which those at the right and lower edges may reach beyond the level. Level i is
/// max(1, width >> i) by max(1, height >> i), and so for a volume's depth. No attachment is a volume; it
/// holds what passes store. With one sample a pixel it may begin with texels (attachment_texels.h).
struct Image {
  std::string name;
  Format format = Format::kR8G8B8A8Unorm;
  std::uint32_t width = 1, height = 1, levels = 1;
  std::vector<std::byte> texels;
  /// instead of `texels`, for a machine that asks for what it samples; null: they are there
  std::shared_ptr<const UnpackTexels> packed{};
  std::uint8_t usage = kSampled;  ///< of `ImageUsage`
  std::uint32_t samples = 1;      ///< a pixel: 1, or of an attachment of one level 2, 4 or 8
  std::uint32_t layers = 1;       ///< images of this size and as many levels
  ImageKind kind = ImageKind::k2D;
  std::uint32_t depth = 1;  ///< of a volume
  [[nodiscard]] bool is_attachment() const { return (usage & (kColorAttachment | kDepthAttachment)) != 0; }
  friend bool operator==(const Image&, const Image&) = default;
};
/// Texels of a level.
[[nodiscard]] std::uint32_t level_width(const Image& image, std::uint32_t level);
[[nodiscard]] std::uint32_t level_height(const Image& image, std::uint32_t level);
[[nodiscard]] std::uint32_t level_depth(const Image& image, std::uint32_t level);
/// A level of a layer of an image, of which a pass may draw to one by itself.
struct ImagePart {
  Index image = kNone;
  std::uint32_t level = 0, layer = 0;
  friend auto operator<=>(const ImagePart&, const ImagePart&) = default;  // NOLINT(modernize-use-nullptr)
};
/// Bytes of a level's texels of a layer, and of all levels and layers.
[[nodiscard]] std::uint64_t level_bytes(const Image& image, std::uint32_t level);
[[nodiscard]] std::uint64_t texel_bytes(const Image& image);
/// Puts the texels of a packed image into `texels`. Throws `UserError`.
void unpack(Image& image);
/// An image whose texels are there, with its blocks decoded where its format is a compressed one: as it is
/// sampled, in the format that the texels then have.
[[nodiscard]] Image decompressed(const Image& image);

struct Shader {
  std::string name;
  ShaderStage stage = ShaderStage::kVertex;
  std::vector<std::uint32_t> spirv;  ///< entry point "main"
  friend bool operator==(const Shader&, const Shader&) = default;
};

struct VertexBinding {
  std::uint32_t binding = 0, stride = 0;
  bool per_instance = false;
  friend bool operator==(const VertexBinding&, const VertexBinding&) = default;
};
struct VertexAttribute {
  std::uint32_t location = 0, binding = 0;
  Format format = Format::kR32G32B32Float;
  std::uint32_t offset = 0;
  friend bool operator==(const VertexAttribute&, const VertexAttribute&) = default;
};
struct DepthState {
  bool test = false, write = false;
  CompareOp compare = CompareOp::kLess;
  friend bool operator==(const DepthState&, const DepthState&) = default;
};
struct Pipeline {
  std::string name;
  Index vertex_shader = kNone, fragment_shader = kNone;
  std::vector<VertexBinding> bindings;
  std::vector<VertexAttribute> attributes;
  Topology topology = Topology::kTriangleList;
  /// An index of all ones ends a strip or fan, and the next index begins another.
  bool primitive_restart = false;
  PolygonMode polygon_mode = PolygonMode::kFill;
  LineMode line_mode = LineMode::kBresenham;
  float line_width = 1;  ///< pixels
  CullMode cull = CullMode::kNone;
  FrontFace front = FrontFace::kCounterClockwise;
  bool depth_clamp = false;
  DepthState depth;
  DepthBias depth_bias{};  ///< of triangles
  DepthBoundsTest depth_bounds{};
  StencilState stencil{};  ///< of a depth attachment that has stencil values
  BlendShared blend_shared{};
  std::array<BlendState, kMaxColorAttachments> blend;  ///< by colour attachment of the pass
  /// Each covered sample is shaded for itself, where it lies; so it is too if the fragment shader asks for
  /// its sample.
  bool sample_shading = false;
  /// Alpha of the first colour says which samples a fragment keeps.
  bool alpha_to_coverage = false;
  std::uint32_t sample_mask = ~0u;  ///< samples that may be covered, a bit each
  /// Fragments are put over the colours by their depths, not in the order of drawing: of passes that keep
  /// them (`BeginPass::transparency`). Blending is `models::is_over`, and no depth is written.
  bool order_independent = false;
  /// Viewports and scissors that its draws have, 1..`models::kMaxViewports`. The vertex shader says by
  /// gl_ViewportIndex which one a primitive takes; of a number that there is not, the first.
  std::uint32_t viewports = 1;
  friend bool operator==(const Pipeline&, const Pipeline&) = default;
};

struct UniformBinding {
  std::uint32_t binding = 0;
  Index buffer = kNone;
  std::uint32_t offset = 0, range = 0;  ///< bytes
  friend bool operator==(const UniformBinding&, const UniformBinding&) = default;
};
struct TextureDescriptor {
  std::uint32_t binding = 0;
  Index image = kNone, sampler = kNone;
  /// What is sampled: so many levels, from this one on, which is the finest. 0: all behind it. Of an array or
  /// a cube, so many layers from `layer` on; else that one. Of several samples a pixel the view is one of the
  /// multisampled kinds.
  std::uint32_t first_level = 0, levels = 0, layer = 0;
  ViewKind view = ViewKind::k2D;
  std::uint32_t layers = 1;
  models::ComponentMapping components = models::kSameComponents;  ///< in the order that is shown
  friend bool operator==(const TextureDescriptor&, const TextureDescriptor&) = default;
};
/// A sampler for textures that bring none (`TextureDescriptor::sampler` is `kNone`).
struct SamplerDescriptor {
  std::uint32_t binding = 0;
  Index sampler = kNone;
  friend bool operator==(const SamplerDescriptor&, const SamplerDescriptor&) = default;
};
/// A range of a buffer that programs may read and write.
struct StorageBinding {
  std::uint32_t binding = 0;
  Index buffer = kNone;
  std::uint32_t offset = 0, range = 0;  ///< bytes
  friend bool operator==(const StorageBinding&, const StorageBinding&) = default;
};
struct DescriptorSet {
  std::vector<UniformBinding> uniforms;
  std::vector<TextureDescriptor> textures;
  std::vector<StorageBinding> buffers{};
  std::vector<SamplerDescriptor> samplers{};
  friend bool operator==(const DescriptorSet&, const DescriptorSet&) = default;
};

// Commands.
/// The fragment shader's output at location i goes to colour attachment i.
struct AttachmentUse {
  Index image = kNone;
  LoadOp load = LoadOp::kClear;
  StoreOp store = StoreOp::kStore;
  std::uint32_t level = 0, layer = 0;  ///< of the image: what is drawn to
  [[nodiscard]] ImagePart part() const { return {image, level, layer}; }
  friend bool operator==(const AttachmentUse&, const AttachmentUse&) = default;
};
struct ColorAttachmentUse : AttachmentUse {
  std::array<float, 4> clear{0, 0, 0, 1};  ///< linear values
  /// In place of `clear` where the format holds integers: their bits, which it has to be able to hold.
  std::array<std::uint32_t, 4> clear_integers{0, 0, 0, 1};
  /// An image of one sample and the same format: holds the means of the samples when the pass ends.
  Index resolve = kNone;
  std::uint32_t resolve_level = 0, resolve_layer = 0;
  [[nodiscard]] ImagePart resolve_part() const { return {resolve, resolve_level, resolve_layer}; }
  friend bool operator==(const ColorAttachmentUse&, const ColorAttachmentUse&) = default;
};
struct DepthAttachmentUse : AttachmentUse {
  float clear = 1;
  std::uint8_t clear_stencil = 0;
  friend bool operator==(const DepthAttachmentUse&, const DepthAttachmentUse&) = default;
};
/// All attachments have one extent and one number of samples, and there is at least one. The last pass of a
/// stream is shown: it has a colour attachment, and number 0, or what it is resolved to, is the picture.
struct BeginPass {
  std::vector<ColorAttachmentUse> colors;
  DepthAttachmentUse depth;  ///< without image: the pass has no depth attachment
  /// Of a pass with one colour attachment. Behind its order-independent draws come no others that write
  /// depths or colours.
  TransparencyState transparency{};
  [[nodiscard]] const AttachmentUse& first() const {
    return colors.empty() ? static_cast<const AttachmentUse&>(depth) : colors[0];
  }
  [[nodiscard]] Index first_image() const { return first().image; }
  friend bool operator==(const BeginPass&, const BeginPass&) = default;
};
struct EndPass {
  friend bool operator==(const EndPass&, const EndPass&) = default;
};
struct BindPipeline {
  Index pipeline = kNone;
  friend bool operator==(const BindPipeline&, const BindPipeline&) = default;
};
struct BindDescriptorSet {
  std::uint32_t set = 0;
  Index descriptors = kNone;
  friend bool operator==(const BindDescriptorSet&, const BindDescriptorSet&) = default;
};
struct BindVertexBuffer {
  std::uint32_t binding = 0;
  Index buffer = kNone;
  std::uint64_t offset = 0;
  friend bool operator==(const BindVertexBuffer&, const BindVertexBuffer&) = default;
};
enum class IndexType : std::uint8_t { kUint8, kUint16, kUint32 };
struct BindIndexBuffer {
  Index buffer = kNone;
  std::uint64_t offset = 0;
  IndexType type = IndexType::kUint16;
  friend bool operator==(const BindIndexBuffer&, const BindIndexBuffer&) = default;
};
struct PushConstants {
  std::uint32_t offset = 0;
  std::vector<std::byte> data;
  friend bool operator==(const PushConstants&, const PushConstants&) = default;
};
struct SetViewport {
  float x = 0, y = 0, width = 0, height = 0, min_depth = 0, max_depth = 1;
  std::uint32_t index = 0;
  friend bool operator==(const SetViewport&, const SetViewport&) = default;
};
struct SetScissor {
  std::int32_t x = 0, y = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t index = 0;
  friend bool operator==(const SetScissor&, const SetScissor&) = default;
};
/// Indexed when `indexed`: `first` is the first index, `vertex_offset` is added to each; otherwise `first` is
/// the first vertex.
struct Draw {
  bool indexed = false;
  std::uint32_t count = 0, first = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t instances = 1, first_instance = 0;
  std::string label;
  friend bool operator==(const Draw&, const Draw&) = default;
};
using Command =
    std::variant<BeginPass, EndPass, BindPipeline, BindDescriptorSet, BindVertexBuffer, BindIndexBuffer,
                 PushConstants, SetViewport, SetScissor, Draw, BeginQuery, EndQuery>;

struct CommandStream {
  std::string name;
  std::vector<Buffer> buffers;
  std::vector<Image> images;
  std::vector<Sampler> samplers;
  std::vector<Shader> shaders;
  std::vector<Pipeline> pipelines;
  std::vector<DescriptorSet> descriptor_sets;
  std::vector<QueryPool> query_pools{};
  std::vector<Command> commands;
  friend bool operator==(const CommandStream&, const CommandStream&) = default;
};

/// Levels that a descriptor names.
[[nodiscard]] std::uint32_t level_count(const CommandStream& stream, const TextureDescriptor& texture);

/// Images that bring texels.
[[nodiscard]] std::size_t texture_count(const CommandStream& stream);

/// Width and height of a pass's attachments, of formats `color` and `depth` (kUndefined: none) and of one
/// sample a pixel.
struct PassTarget {
  std::uint32_t width = 0, height = 0;
  Format color = Format::kR8G8B8A8Srgb;
  Format depth = Format::kD32Float;
};
/// Adds the images of a pass with one colour attachment to the stream, and returns the command that clears
/// them at its begin and stores them at its end.
[[nodiscard]] BeginPass make_pass(CommandStream& stream, const PassTarget& target,
                                  const std::array<float, 4>& clear_color = {0, 0, 0, 1},
                                  float clear_depth = 1);
/// What the stream's last pass draws to, which is what is shown. The stream has a pass.
[[nodiscard]] PassTarget shown_target(const CommandStream& stream);
/// What a pass draws to.
[[nodiscard]] PassTarget target_of(const CommandStream& stream, const BeginPass& pass);

/// Lets every pass draw to attachments of `samples` samples a pixel, and resolve them to its own. A pass
/// stays as it is where that would change what others see: one that loads an attachment, or whose attachment
/// another loads, or whose depth is sampled. Throws `UserError` if that is the last one, or if the stream has
/// several samples already.
void use_samples(CommandStream& stream, std::uint32_t samples);
/// Lets every pipeline shade by sample: with several samples a pixel, full supersampling.
void use_sample_shading(CommandStream& stream);
/// Lets every sampler that filters between texels and levels take up to `samples` samples along an axis.
void use_anisotropy(CommandStream& stream, float samples);

inline constexpr std::uint32_t kMaxPushConstantBytes = 256;

/// Checks every reference, range and size, so that nothing that executes the stream has to. Throws
/// `UserError` naming the object or command.
void validate(const CommandStream& stream);

}  // namespace quadrille::traces
