/// The gate of the command stream: objects are checked here, commands by the walk in validate_draws.h, so
/// that whatever executes a stream may trust it.
///
/// Rules are Vulkan's valid-usage rules, made stricter where that spares every executor a case; limits are
/// the ones below.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "traces/attachment_texels.h"
#include "traces/command_stream.h"
#include "traces/validate_draws.h"

namespace quadrille::traces {
namespace {

constexpr std::uint32_t kMaxSide = 16384;  // texels or pixels [VK1.3 #limits-maxImageDimension2D]
constexpr std::uint32_t kMaxDepth = 2048;  // texels of a side of a volume
constexpr std::uint64_t kMaxTexelBytes = std::uint64_t{1} << 33;
constexpr std::uint32_t kMaxLayers = 256;  // [VK1.3 #limits-required: maxImageArrayLayers]
// bindings and locations [VK1.3 #limits-required: maxVertexInputBindings]
constexpr std::uint32_t kMaxVertexSlots = 16;
// bytes [VK1.3 #limits-required: maxVertexInputBindingStride]
constexpr std::uint32_t kMaxStride = 2048;
// bytes [VK1.3 #limits-required: maxVertexInputAttributeOffset]
constexpr std::uint32_t kMaxAttributeOffset = 2047;
constexpr std::uint32_t kMaxUniformRange = 65536;                   // bytes
constexpr std::uint32_t kMaxStorageRange = std::uint32_t{1} << 30;  // bytes
constexpr std::uint32_t kBlockAlignment = 16;                       // bytes
constexpr std::uint32_t kSpirvMagic = 0x07230203;

void check_side(const char* what, std::size_t index, std::uint32_t width, std::uint32_t height) {
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide) {
    throw user_error("{} {}: size {}x{} is outside 1x1 .. {}x{}", what, index, width, height, kMaxSide,
                     kMaxSide);
  }
}

void check_usage(const Image& image, std::size_t index) {
  const models::FormatInfo& format = models::format_info(image.format);
  if (image.usage == 0 || (image.usage & ~kAllUsages) != 0)
    throw user_error("image {} '{}': usage {:#x} is not a set of sampled, colour and depth attachment", index,
                     image.name, image.usage);
  const auto refuse = [&](const char* use) {
    throw user_error("image {} '{}': its format {} is not one of a {}", index, image.name, format.name, use);
  };
  if ((image.usage & kColorAttachment) != 0 && !format.may(models::kColorUse)) refuse("colour attachment");
  if ((image.usage & kDepthAttachment) != 0 && !format.may(models::kDepthUse)) refuse("depth attachment");
  if (!image.is_attachment() && !format.may(models::kFileUse)) refuse("texture");
}

void check_samples(const Image& image, std::size_t index) {
  if (image.samples != 1 && image.samples != 2 && image.samples != 4 && image.samples != 8)
    throw user_error("image {} '{}': {} samples a pixel; 1, 2, 4 and 8 are possible", index, image.name,
                     image.samples);
  if (image.samples > 1 && !image.is_attachment())
    throw user_error("image {} '{}': only an attachment has {} samples a pixel", index, image.name,
                     image.samples);
  if (image.samples > 1 && image.kind != ImageKind::k2D)
    throw user_error("image {} '{}': {} samples a pixel of an image that is not 2D", index, image.name,
                     image.samples);
  if (image.samples > 1 && image.levels > 1)
    throw user_error("image {} '{}': {} levels of {} samples a pixel; it can have one", index, image.name,
                     image.levels, image.samples);
}

void check_texels(const Image& image, std::size_t index) {
  const bool brings = !image.packed && (!image.is_attachment() || begins_with_texels(image));
  const std::uint64_t bytes = brings ? texel_bytes(image) : 0;
  if (image.is_attachment() && image.packed)
    throw user_error("image {} '{}': an attachment that is packed", index, image.name);
  if (begins_with_texels(image) && image.samples > 1)
    throw user_error("image {} '{}': an attachment of {} samples a pixel brings texels; one of 1 may", index,
                     image.name, image.samples);
  const std::uint32_t most_layers = image.kind == ImageKind::k3D ? 1 : kMaxLayers;
  if (image.layers == 0 || image.layers > most_layers)
    throw user_error("image {} '{}': {} layers; 1..{} are possible (1 of a volume)", index, image.name,
                     image.layers, most_layers);
  if (image.texels.size() != bytes) {
    throw user_error("image {} '{}': {} bytes of texels where {}x{} with {} levels takes {}", index,
                     image.name, image.texels.size(), image.width, image.height, image.levels, bytes);
  }
}

/// Depths are what passes could have stored.
void check_depths(const Image& image, std::size_t index) {
  const bool floats = image.format == Format::kD32Float || image.format == Format::kD32FloatS8Uint;
  if (!floats || !begins_with_texels(image)) return;
  for (std::size_t at = 0; at < image.texels.size(); at += format_bytes(image.format)) {
    float depth = 0;
    std::memcpy(&depth, &image.texels[at], sizeof depth);
    if (!(depth >= 0 && depth <= 1))
      throw user_error("image {} '{}': it begins with a depth of {}, which is outside 0..1", index,
                       image.name, depth);
  }
}

void check_kind(const Image& image, std::size_t index) {
  if (image.kind == ImageKind::k3D && image.is_attachment())
    throw user_error("image {} '{}': an attachment that is a volume", index, image.name);
  const std::uint32_t most = image.kind == ImageKind::k3D ? kMaxDepth : 1;
  if (image.depth == 0 || image.depth > most)
    throw user_error("image {} '{}': depth {}; 1..{} are possible (1 unless it is a volume)", index,
                     image.name, image.depth, most);
  if (image.kind == ImageKind::k1D && image.height != 1)
    throw user_error("image {} '{}': a line of texels with height {}; it must be 1", index, image.name,
                     image.height);
  if (image.kind == ImageKind::k3D && std::max(image.width, image.height) > kMaxDepth)
    throw user_error("image {} '{}': a volume of {}x{}; each side must be 1..{}", index, image.name,
                     image.width, image.height, kMaxDepth);
  const bool brings = !image.is_attachment() || begins_with_texels(image);
  if (brings && texel_bytes(image) > kMaxTexelBytes)
    throw user_error("image {} '{}': {} bytes of texels; at most {} are possible", index, image.name,
                     texel_bytes(image), kMaxTexelBytes);
}

void check_image(const Image& image, std::size_t index) {
  check_side("image", index, image.width, image.height);
  check_kind(image, index);
  check_usage(image, index);
  check_samples(image, index);
  const auto full_chain =
      static_cast<std::uint32_t>(std::bit_width(std::max({image.width, image.height, image.depth})));
  if (image.levels == 0 || image.levels > full_chain) {
    throw user_error("image {} '{}': {} mip levels; {}x{} allows 1..{}", index, image.name, image.levels,
                     image.width, image.height, full_chain);
  }
  check_texels(image, index);
  check_depths(image, index);
}

void check_sampler(const Sampler& sampler, std::size_t index) {
  if (!std::isfinite(sampler.lod_bias) || std::abs(sampler.lod_bias) > 16)
    throw user_error("sampler {}: lod bias {} is outside -16..16", index, sampler.lod_bias);
  if (!std::isfinite(sampler.min_lod) || !std::isfinite(sampler.max_lod) ||
      sampler.min_lod > sampler.max_lod) {
    throw user_error("sampler {}: lod range {}..{} is not an interval", index, sampler.min_lod,
                     sampler.max_lod);
  }
  if (!(sampler.max_anisotropy >= 1 && sampler.max_anisotropy <= models::kMaxAnisotropy))
    throw user_error("sampler {}: {} samples along an axis; 1..{} are possible", index,
                     sampler.max_anisotropy, models::kMaxAnisotropy);
}

void check_shader(const Shader& shader, std::size_t index) {
  if (shader.spirv.size() < 5 || shader.spirv[0] != kSpirvMagic)
    throw user_error("shader {} '{}': its words are not SPIR-V", index, shader.name);
}

void check_stage(const CommandStream& stream, const Pipeline& pipeline, std::size_t index, Index shader,
                 ShaderStage stage, const char* stage_name) {
  if (shader >= stream.shaders.size()) {
    throw user_error("pipeline {} '{}': {} shader {} does not exist ({} shaders)", index, pipeline.name,
                     stage_name, shader, stream.shaders.size());
  }
  if (stream.shaders[shader].stage != stage)
    throw user_error("pipeline {} '{}': shader {} is not a {} shader", index, pipeline.name, shader,
                     stage_name);
}

void check_vertex_input(const Pipeline& pipeline, std::size_t index) {
  std::set<std::uint32_t> bindings, locations;
  for (const auto& b : pipeline.bindings) {
    if (b.binding >= kMaxVertexSlots)
      throw user_error("pipeline {} '{}': vertex binding {} is outside 0..15", index, pipeline.name,
                       b.binding);
    if (!bindings.insert(b.binding).second)
      throw user_error("pipeline {} '{}': vertex binding {} is given twice", index, pipeline.name, b.binding);
    if (b.stride > kMaxStride)
      throw user_error("pipeline {} '{}': binding {} has stride {}, the limit is {}", index, pipeline.name,
                       b.binding, b.stride, kMaxStride);
  }
  for (const auto& a : pipeline.attributes) {
    if (a.location >= kMaxVertexSlots)
      throw user_error("pipeline {} '{}': location {} is outside 0..15", index, pipeline.name, a.location);
    if (!locations.insert(a.location).second)
      throw user_error("pipeline {} '{}': location {} is given twice", index, pipeline.name, a.location);
    if (!bindings.contains(a.binding))
      throw user_error("pipeline {} '{}': location {} reads binding {}, which is not declared", index,
                       pipeline.name, a.location, a.binding);
    if (!models::format_info(a.format).may(models::kAttributeUse))
      throw user_error("pipeline {} '{}': location {} has a format that is not one of an attribute", index,
                       pipeline.name, a.location);
    if (a.offset > kMaxAttributeOffset)
      throw user_error("pipeline {} '{}': location {} has offset {}, the limit is {}", index, pipeline.name,
                       a.location, a.offset, kMaxAttributeOffset);
  }
}

void check_primitives(const Pipeline& pipeline, std::size_t index) {
  if (pipeline.primitive_restart && models::is_list(pipeline.topology))
    throw user_error("pipeline {} '{}': primitive restart in a list of primitives (strips and fans have it)",
                     index, pipeline.name);
  if (!(pipeline.line_width >= models::kMinLineWidth && pipeline.line_width <= models::kMaxLineWidth))
    throw user_error("pipeline {} '{}': line width {} is outside {}..{}", index, pipeline.name,
                     pipeline.line_width, models::kMinLineWidth, models::kMaxLineWidth);
}

void check_finite(const Pipeline& pipeline, std::size_t index, const char* what,
                  std::initializer_list<float> values) {
  if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
    throw user_error("pipeline {} '{}': its {} are not all finite", index, pipeline.name, what);
}

void check_tests(const Pipeline& pipeline, std::size_t index) {
  const DepthBias& bias = pipeline.depth_bias;
  check_finite(pipeline, index, "numbers of depth bias", {bias.constant, bias.slope, bias.clamp});
  const DepthBoundsTest& bounds = pipeline.depth_bounds;
  if (!(bounds.least >= 0 && bounds.most <= 1 && bounds.least <= bounds.most))
    throw user_error("pipeline {} '{}': depth bounds {}..{} are not an interval within 0..1", index,
                     pipeline.name, bounds.least, bounds.most);
  const auto& c = pipeline.blend_shared.constants;
  check_finite(pipeline, index, "blend constants", {c[0], c[1], c[2], c[3]});
  for (std::size_t i = 1; i < pipeline.blend.size(); ++i) {
    if (pipeline.blend[i].uses_second_source())
      throw user_error("pipeline {} '{}': attachment {} is blended by a second colour; only 0 can be", index,
                       pipeline.name, i);
  }
}

void check_order_independent(const Pipeline& pipeline, std::size_t index) {
  if (!pipeline.order_independent) return;
  if (!models::is_over(pipeline.blend[0]) || pipeline.blend_shared.logic)
    throw user_error(
        "pipeline {} '{}': order-independent, but its blending is not one over the other: (one or source "
        "alpha, one minus source alpha), alpha (one, one minus source alpha), added, all components written",
        index, pipeline.name);
  if (pipeline.depth.write)
    throw user_error("pipeline {} '{}': order-independent, but it writes depths", index, pipeline.name);
}

void check_pipeline(const CommandStream& stream, const Pipeline& pipeline, std::size_t index) {
  check_stage(stream, pipeline, index, pipeline.vertex_shader, ShaderStage::kVertex, "vertex");
  check_stage(stream, pipeline, index, pipeline.fragment_shader, ShaderStage::kFragment, "fragment");
  check_vertex_input(pipeline, index);
  check_primitives(pipeline, index);
  check_tests(pipeline, index);
  check_order_independent(pipeline, index);
  if (pipeline.viewports == 0 || pipeline.viewports > models::kMaxViewports)
    throw user_error("pipeline {} '{}': {} viewports; 1..{} are possible", index, pipeline.name,
                     pipeline.viewports, models::kMaxViewports);
  for (const BlendState& blend : pipeline.blend) {
    if (blend.write_mask > 0xf)
      throw user_error("pipeline {} '{}': write mask {:#x} has bits beyond rgba", index, pipeline.name,
                       blend.write_mask);
  }
}

/// Of a uniform or storage buffer.
template <class Block>
void check_block(const CommandStream& stream, std::size_t set, const Block& block, std::uint32_t most) {
  if (block.buffer >= stream.buffers.size())
    throw user_error("descriptor set {} binding {}: buffer {} does not exist", set,
                     models::binding_text(block.binding), block.buffer);
  const std::uint64_t size = stream.buffers[block.buffer].data.size();
  if (block.range == 0 || block.range > most || std::uint64_t{block.offset} + block.range > size) {
    throw user_error(
        "descriptor set {} binding {}: bytes {}+{} are not within buffer {} of {} bytes (at most {})", set,
        models::binding_text(block.binding), block.offset, block.range, block.buffer, size, most);
  }
  if (block.offset % kBlockAlignment != 0)
    throw user_error("descriptor set {} binding {}: offset {} is not a multiple of {}", set,
                     models::binding_text(block.binding), block.offset, kBlockAlignment);
}

/// [VK1.3 #resources-image-views-compatibility]
void check_view_kind(const Image& image, const TextureDescriptor& t, std::size_t set) {
  const std::string_view kind = models::kViewKindNames.at(static_cast<std::size_t>(t.view));
  if (models::image_kind(t.view) != image.kind)
    throw user_error("descriptor set {} binding {}: a view '{}' of image {} '{}', which is of another kind",
                     set, models::binding_text(t.binding), kind, t.image, image.name);
  if (models::is_multisampled(t.view) != (image.samples > 1))
    throw user_error("descriptor set {} binding {}: a view '{}' of image {} '{}' of {} samples a pixel", set,
                     models::binding_text(t.binding), kind, t.image, image.name, image.samples);
  if (t.layers == 0 || t.layers > image.layers - t.layer)
    throw user_error("descriptor set {} binding {}: layers {}+{} of image {} '{}', which has {}", set,
                     models::binding_text(t.binding), t.layer, t.layers, t.image, image.name, image.layers);
  const bool fits = models::is_cube(t.view)    ? t.layers % models::kCubeFaces == 0
                    : models::is_array(t.view) ? true
                                               : t.layers == 1;
  if (!fits || (t.view == ViewKind::kCube && t.layers != models::kCubeFaces))
    throw user_error("descriptor set {} binding {}: {} layers in a view '{}'", set,
                     models::binding_text(t.binding), t.layers, kind);
  if (models::is_cube(t.view) && image.width != image.height)
    throw user_error("descriptor set {} binding {}: image {} '{}' of {}x{} texels as a cube", set,
                     models::binding_text(t.binding), t.image, image.name, image.width, image.height);
}

/// Levels and layer that are sampled are those of the image.
void check_view(const CommandStream& stream, const TextureDescriptor& t, std::size_t set) {
  const Image& image = stream.images[t.image];
  if (t.first_level >= image.levels || t.levels > image.levels - t.first_level)
    throw user_error("descriptor set {} binding {}: levels {}+{} of image {} '{}', which has {}", set,
                     models::binding_text(t.binding), t.first_level, t.levels, t.image, image.name,
                     image.levels);
  if (t.layer >= image.layers)
    throw user_error("descriptor set {} binding {}: layer {} of image {} '{}', which has {}", set,
                     models::binding_text(t.binding), t.layer, t.image, image.name, image.layers);
  check_view_kind(image, t, set);
}

/// Integers have no numbers between them. [VK1.3 #textures-texel-filtering] Samples are not filtered.
void check_filters(const CommandStream& stream, const TextureDescriptor& t, std::size_t set) {
  if (t.sampler == kNone || models::is_multisampled(t.view)) return;
  const Image& image = stream.images[t.image];
  const Sampler& sampler = stream.samplers[t.sampler];
  if (!is_integer_format(image.format)) return;
  for (const Filter filter : {sampler.mag, sampler.min, sampler.mip}) {
    if (filter == Filter::kLinear)
      throw user_error("descriptor set {} binding {}: image {} '{}' of integers ({}) with a linear filter",
                       set, models::binding_text(t.binding), t.image, image.name,
                       models::format_info(image.format).name);
  }
}

void check_descriptors(const CommandStream& stream, const DescriptorSet& descriptors, std::size_t set) {
  std::set<std::uint32_t> bindings;
  const auto claim = [&](std::uint32_t binding) {
    if (!bindings.insert(binding).second)
      throw user_error("descriptor set {}: binding {} is given twice", set, models::binding_text(binding));
  };
  for (const auto& u : descriptors.uniforms) {
    claim(u.binding);
    check_block(stream, set, u, kMaxUniformRange);
  }
  for (const auto& b : descriptors.buffers) {
    claim(b.binding);
    check_block(stream, set, b, kMaxStorageRange);
  }
  for (const auto& t : descriptors.textures) {
    claim(t.binding);
    if (t.image >= stream.images.size())
      throw user_error("descriptor set {} binding {}: image {} does not exist", set,
                       models::binding_text(t.binding), t.image);
    if ((stream.images[t.image].usage & kSampled) == 0)
      throw user_error("descriptor set {} binding {}: image {} '{}' is not for sampling", set,
                       models::binding_text(t.binding), t.image, stream.images[t.image].name);
    if (t.sampler >= stream.samplers.size() && t.sampler != kNone)
      throw user_error("descriptor set {} binding {}: sampler {} does not exist", set,
                       models::binding_text(t.binding), t.sampler);
    check_view(stream, t, set);
    check_filters(stream, t, set);
  }
  for (const auto& s : descriptors.samplers) {
    claim(s.binding);
    if (s.sampler >= stream.samplers.size())
      throw user_error("descriptor set {} binding {}: sampler {} does not exist", set,
                       models::binding_text(s.binding), s.sampler);
  }
}

}  // namespace

void validate(const CommandStream& stream) {
  for (std::size_t i = 0; i < stream.images.size(); ++i) check_image(stream.images[i], i);
  for (std::size_t i = 0; i < stream.samplers.size(); ++i) check_sampler(stream.samplers[i], i);
  for (std::size_t i = 0; i < stream.shaders.size(); ++i) check_shader(stream.shaders[i], i);
  for (std::size_t i = 0; i < stream.pipelines.size(); ++i) check_pipeline(stream, stream.pipelines[i], i);
  for (std::size_t i = 0; i < stream.descriptor_sets.size(); ++i)
    check_descriptors(stream, stream.descriptor_sets[i], i);
  for (std::size_t i = 0; i < stream.query_pools.size(); ++i) check_query_pool(stream.query_pools[i], i);
  CommandWalk(stream).run();
}

}  // namespace quadrille::traces
