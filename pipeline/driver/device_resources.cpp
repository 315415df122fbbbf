#include "pipeline/driver/device_resources.h"

#include "models/memory/surface.h"
#include "traces/attachment_texels.h"

#include <algorithm>
#include <cstring>

namespace quadrille::pipeline {

namespace {

models::TextureExtent extent_of(const traces::Image& image) {
  return {image.width, image.height, image.depth, image.layers};
}

models::SurfaceLayout level_surface(const traces::Image& image, std::uint32_t level) {
  return models::surface_layout(traces::level_width(image, level), traces::level_height(image, level),
                                image.samples, models::format_bytes(image.format));
}

/// Writes the texels of a level of a layer to where they lie, before the frame begins.
void bring_texels(models::DeviceMemory& memory, const models::SurfaceLayout& surface,
                  std::span<const std::byte> texels) {
  const std::span<std::byte> bytes = memory.write(surface.base, surface.bytes());
  const std::byte* from = texels.data();
  for (std::uint32_t y = 0; y < surface.height; ++y)
    for (std::uint32_t x = 0; x < surface.width; ++x, from += surface.pixel_bytes)
      std::memcpy(bytes.data() + (surface.pixel_address(x, y) - surface.base), from, surface.pixel_bytes);
}

}  // namespace

models::TextureSize size_of(const traces::CommandStream& stream, const traces::TextureDescriptor& bound) {
  const traces::Image& image = stream.images[bound.image];
  const std::uint32_t layers = models::is_array(bound.view) ? bound.layers : 0;
  return {traces::level_width(image, bound.first_level),
          traces::level_height(image, bound.first_level),
          traces::level_count(stream, bound),
          traces::level_depth(image, bound.first_level),
          models::is_cube(bound.view) ? layers / models::kCubeFaces : layers,
          models::is_multisampled(bound.view) ? image.samples : 0};
}

DeviceResources::DeviceResources(const traces::CommandStream& stream, models::DeviceMemory& memory,
                                 TextureFills& fills, models::Tiling tiling)
    : stream_(stream),
      memory_(memory),
      fills_(fills),
      tiling_(tiling),
      buffers_(stream.buffers.size()),
      textures_(stream.images.size()),
      surfaces_(stream.images.size()) {
  std::uint64_t bytes = 0;
  const auto add = [&bytes](std::uint64_t size) {
    bytes += (size + models::kLineBytes - 1) / models::kLineBytes * models::kLineBytes;
  };
  for (const traces::Buffer& b : stream.buffers) add(std::max<std::size_t>(1, b.data.size()));
  for (const traces::Image& i : stream.images) {
    if (!i.is_attachment()) add(models::make_texture_layout(i.format, extent_of(i), i.levels, tiling_).bytes);
    else
      for (std::uint32_t level = 0; level < i.levels; ++level)
        add(i.layers * level_surface(i, level).bytes());
  }
  memory.reserve(bytes);
}

std::uint64_t DeviceResources::buffer(traces::Index index) {
  std::optional<std::uint64_t>& address = buffers_[index];
  if (!address) {
    const std::vector<std::byte>& data = stream_.buffers[index].data;
    address = memory_.allocate(std::max<std::size_t>(1, data.size()));
    if (!data.empty()) std::memcpy(memory_.write(*address, data.size()).data(), data.data(), data.size());
    buffer_bytes_ += data.size();
  }
  return *address;
}

DeviceResources::Texture DeviceResources::texture(const traces::TextureDescriptor& bound) {
  const traces::Image& image = stream_.images[bound.image];
  const std::uint32_t levels = traces::level_count(stream_, bound);
  if (image.is_attachment()) {
    (void)layer(bound.image, bound.layer);
    const auto seen =
        std::span(surfaces_[bound.image])
            .subspan(std::size_t{bound.layer} * image.levels, std::size_t{bound.layers} * image.levels);
    models::TextureView view = models::view_of_surfaces(seen, image.levels, image.format);
    view = models::view_of_levels(view, bound.first_level, levels);
    view.kind = bound.view;
    view.components = bound.components;
    return {view, nullptr};
  }
  const Texture& whole = whole_texture(bound.image);
  models::TextureView view = models::view_of_levels(whole.view, bound.first_level, levels);
  if (image.kind != traces::ImageKind::k3D) view = models::view_of_layers(view, bound.layer, bound.layers);
  view.kind = bound.view;
  view.components = bound.components;
  return {view, whole.fill};
}

const DeviceResources::Texture& DeviceResources::whole_texture(traces::Index image) {
  std::optional<Texture>& texture = textures_[image];
  if (!texture) {
    const traces::Image& i = stream_.images[image];
    const models::TextureView view =
        models::allocate_texture(memory_, i.format, extent_of(i), i.levels, tiling_);
    texture = {view, &fills_.add(i, view)};
    texture_bytes_ += view.layout.bytes;
  }
  return *texture;
}

std::span<const models::SurfaceLayout> DeviceResources::layer(traces::Index index, std::uint32_t layer) {
  std::vector<models::SurfaceLayout>& surfaces = surfaces_[index];
  const traces::Image& image = stream_.images[index];
  if (surfaces.empty()) {
    surfaces.reserve(std::size_t{image.layers} * image.levels);
    for (std::uint32_t l = 0; l < image.layers; ++l)
      for (std::uint32_t level = 0; level < image.levels; ++level) place_level(image, l, level, surfaces);
  }
  return std::span(surfaces).subspan(std::size_t{layer} * image.levels, image.levels);
}

void DeviceResources::place_level(const traces::Image& image, std::uint32_t layer, std::uint32_t level,
                                  std::vector<models::SurfaceLayout>& surfaces) {
  surfaces.push_back(surface(level_surface(image, level)));
  if (traces::begins_with_texels(image))
    bring_texels(memory_, surfaces.back(), traces::part_texels(image, level, layer));
}

const models::SurfaceLayout& DeviceResources::attachment(const traces::ImagePart& part) {
  return layer(part.image, part.layer)[part.level];
}

models::SurfaceLayout DeviceResources::surface(const models::SurfaceLayout& wanted) {
  models::SurfaceLayout placed = wanted;
  placed.base = memory_.allocate(wanted.bytes(), models::kSurfaceAlignment);
  surface_bytes_ += placed.bytes();
  return placed;
}

void DeviceResources::place_rest() {
  for (traces::Index i = 0; i < buffers_.size(); ++i) (void)buffer(i);
  for (traces::Index i = 0; i < textures_.size(); ++i) {
    if (!stream_.images[i].is_attachment()) whole_texture(i).fill->need();
  }
}

DeviceResources::Unplaced DeviceResources::unplaced_images() const {
  Unplaced unplaced;
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    if (textures_[i] || stream_.images[i].is_attachment()) continue;
    ++unplaced.images;
    unplaced.bytes += traces::texel_bytes(stream_.images[i]);
  }
  return unplaced;
}

}  // namespace quadrille::pipeline
