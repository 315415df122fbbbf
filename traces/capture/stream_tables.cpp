#include "traces/capture/stream_tables.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/base/error.h"
#include "traces/capture/texels.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {

using traces::Index;

namespace {

template <class T>
Index append(std::vector<T>& table, T value) {
  table.push_back(std::move(value));
  return static_cast<Index>(table.size() - 1);
}

/// The place of an equal element, or of a new one.
template <class T>
Index place(std::vector<T>& table, const T& value) {
  const auto found = std::ranges::find(table, value);
  if (found != table.end()) return static_cast<Index>(found - table.begin());
  return append(table, value);
}

}  // namespace

bool may_attach(const ImageObject& image) {
  const models::FormatInfo& info = models::format_info(image_format(image.format));
  return image.type != VK_IMAGE_TYPE_3D && (info.may(models::kDepthUse) || info.may(models::kColorUse));
}

Index StreamTables::buffer(Handle handle) {
  if (device_.read_back.contains(handle)) throw user_error("buffer {} holds what a pass drew", handle);
  const BufferObject& object_of = object(device_.buffers, handle, "buffer");
  const std::uint64_t version = device_.version(object_of);
  const auto found = buffers_.find(handle);
  if (found != buffers_.end() && found->second.version == version) return found->second.index;
  traces::Buffer made{fmt::format("buffer {}", handle), device_.contents(object_of)};
  if (found != buffers_.end() && stream.buffers[found->second.index].data == made.data) {
    found->second.version = version;
    return found->second.index;
  }
  const Index index = append(stream.buffers, std::move(made));
  buffers_[handle] = {index, version};
  placed_buffers_[index] = handle;
  return index;
}

Index StreamTables::attachment(Handle handle) {
  const ImageObject& from = object(device_.images, handle, "image");
  const auto found = attachments_.find(handle);
  if (found != attachments_.end() && (found->second.writes == from.writes || stored(handle)))
    return found->second.index;
  traces::Image image;
  image.name = fmt::format("image {}", handle);
  image.format = image_format(from.format);
  const bool depth = models::format_info(image.format).may(models::kDepthUse);
  if (!may_attach(from))
    throw user_error("an attachment of {}{} is not supported", format_name(from.format),
                     from.type == VK_IMAGE_TYPE_3D ? ", a volume" : "");
  image.kind = image_kind_of(from.type);
  image.width = from.width;
  image.height = from.height;
  image.levels = from.levels;
  image.layers = from.layers;
  image.samples = from.samples;
  image.usage = depth ? traces::kDepthAttachment : traces::kColorAttachment;
  if ((from.usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0) image.usage |= traces::kSampled;
  image.texels = attachment_texels(from);
  const Index index = append(stream.images, std::move(image));
  attachments_[handle] = {index, from.writes};
  placed_images_[index] = handle;
  return index;
}

bool StreamTables::holds(Handle image, std::uint32_t level, std::uint32_t layer) const {
  return stored_part(image, level, layer) || holds_part(object(device_.images, image, "image"), level, layer);
}

void StreamTables::note_needed(const traces::ImagePart& part) {
  if (!stored_part(image_of(part.image), part.level, part.layer)) needed_.insert(part.image);
}

Handle StreamTables::image_of(Index attachment) const {
  return object(placed_images_, attachment, "attachment");
}
Handle StreamTables::buffer_of(Index buffer) const { return object(placed_buffers_, buffer, "buffer"); }

void StreamTables::forget_unneeded() {
  for (Index i = 0; i < stream.images.size(); ++i)
    if (stream.images[i].is_attachment() && !needed_.contains(i)) stream.images[i].texels = {};
}

bool StreamTables::stored(Handle image) const {
  const auto found = stored_.lower_bound({image, 0, 0});
  return found != stored_.end() && std::get<0>(*found) == image;
}

traces::TextureDescriptor StreamTables::texture(const ViewObject& view) {
  traces::TextureDescriptor made;
  made.view = view_kind_of(view.type, object(device_.images, view.image, "image").samples);
  for (std::size_t c = 0; c < 4; ++c) made.components[c] = component_of(view.swizzle[c], c);
  if (models::is_array(made.view) || models::is_cube(made.view)) made.layers = view.layers;
  made.first_level = view.level;
  made.levels = view.levels;
  const bool multisampled = models::is_multisampled(made.view);
  if (multisampled && !stored(view.image))
    throw user_error("image {} of several samples a pixel, which no pass of the frame has drawn", view.image);
  if (stored(view.image)) {
    made.image = attachment(view.image);
    made.layer = view.layer;
    // A copy is drawn by sampling, which the program's image may not be for.
    if (stream.images[made.image].samples == 1) stream.images[made.image].usage |= traces::kSampled;
    for (std::uint32_t level = 0; level < view.levels; ++level)
      for (std::uint32_t layer = 0; layer < made.layers; ++layer)
        note_needed({made.image, view.level + level, view.layer + layer});
  } else {
    made.image = texels(view);
  }
  return made;
}

Index StreamTables::texels(const ViewObject& view) {
  const ImageObject& from = object(device_.images, view.image, "image");
  const auto key = std::tuple(view.image, from.writes, view.format, std::pair(view.layer, view.layers));
  if (const auto found = textures_.find(key); found != textures_.end()) return found->second;
  traces::Image image;
  image.name = fmt::format("image {}", view.image);
  image.format = texture_format(view);
  image.width = from.width;
  image.height = from.height;
  image.levels = from.levels;
  image.kind = image_kind_of(from.type);
  image.depth = from.depth;
  image.layers = view.layers;
  bool missing = false;
  image.texels = texture_texels(from, view, missing);
  if (missing) notes_.insert(image.name + " is sampled, but the capture does not hold all of it: zeros");
  return textures_[key] = append(stream.images, std::move(image));
}

Index StreamTables::sampler(Handle handle) {
  if (const auto found = samplers_.find(handle); found != samplers_.end()) return found->second;
  const SamplerObject& from = object(device_.samplers, handle, "sampler");
  if (!from.unsupported.empty()) throw user_error("a sampler with {} is not supported", from.unsupported);
  return samplers_[handle] = sampler(from.state);
}

Index StreamTables::sampler(const traces::Sampler& wanted) { return place(stream.samplers, wanted); }

Index StreamTables::index_buffer(const std::vector<std::uint32_t>& indices) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(indices));
  return append(stream.buffers, traces::Buffer{"turned indices", {bytes.begin(), bytes.end()}});
}

Index StreamTables::expanded_attribute(Handle handle, const AttributeSource& source) {
  const Index from = buffer(handle);
  const auto key = std::tuple(from, source.format, source.offset, source.stride);
  if (const auto found = expanded_.find(key); found != expanded_.end()) return found->second;
  std::vector<std::byte> bytes = expanded_attributes(stream.buffers[from].data, source);
  return expanded_[key] = append(stream.buffers, traces::Buffer{"expanded attributes", std::move(bytes)});
}

Index StreamTables::own(OwnShader which, std::uint32_t location) {
  const auto key = std::pair(which, location);
  if (const auto found = own_.find(key); found != own_.end()) return found->second;
  std::vector<std::uint32_t> words = own_shader(which, location);
  const auto stage =
      which == OwnShader::kArea ? traces::ShaderStage::kVertex : traces::ShaderStage::kFragment;
  facts_.push_back(shader_facts(words));
  return own_[key] = append(stream.shaders, traces::Shader{"fill", stage, std::move(words)});
}

Index StreamTables::shader(Handle module, const ShaderWish& wish) {
  const auto key = std::tuple(module, wish.entry, wish.stage, wish.constants, wish.negative_one_to_one,
                              wish.first_instance, wish.outputs);
  if (const auto found = shaders_.find(key); found != shaders_.end()) return found->second;
  traces::Shader made{fmt::format("shader {}", module), wish.stage,
                      shader_words(object(device_.modules, module, "shader module"), wish)};
  facts_.push_back(shader_facts(made.spirv));
  return shaders_[key] = append(stream.shaders, std::move(made));
}

Index StreamTables::pipeline(const traces::Pipeline& wanted) { return place(stream.pipelines, wanted); }

Index StreamTables::descriptors(const traces::DescriptorSet& wanted) {
  return place(stream.descriptor_sets, wanted);
}

}  // namespace quadrille::capture
