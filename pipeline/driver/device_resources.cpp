#include "pipeline/driver/device_resources.h"

#include "models/memory/surface.h"

#include <algorithm>
#include <cstring>

namespace quadrille::pipeline {

DeviceResources::DeviceResources(const traces::CommandStream& stream, models::DeviceMemory& memory,
                                 TextureFills& fills)
    : stream_(stream),
      memory_(memory),
      fills_(fills),
      buffers_(stream.buffers.size()),
      textures_(stream.images.size()),
      surfaces_(stream.images.size()) {
  std::uint64_t bytes = 0;
  const auto add = [&bytes](std::uint64_t size) {
    bytes += (size + models::kLineBytes - 1) / models::kLineBytes * models::kLineBytes;
  };
  for (const traces::Buffer& b : stream.buffers) add(std::max<std::size_t>(1, b.data.size()));
  for (const traces::Image& i : stream.images)
    add(i.is_attachment()
            ? models::surface_layout(i.width, i.height, i.samples, models::format_bytes(i.format)).bytes()
            : models::make_texture_layout(i.width, i.height, i.levels).bytes);
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

const DeviceResources::Texture& DeviceResources::texture(traces::Index image) {
  std::optional<Texture>& texture = textures_[image];
  if (!texture) {
    const traces::Image& i = stream_.images[image];
    if (i.is_attachment())
      return texture.emplace(Texture{models::view_of_surface(attachment(image), i.format), nullptr});
    const models::TextureView view = models::allocate_texture(memory_, i.format, i.width, i.height, i.levels);
    texture = {view, &fills_.add(i, view)};
    texture_bytes_ += view.layout.bytes;
  }
  return *texture;
}

const models::SurfaceLayout& DeviceResources::attachment(traces::Index image) {
  std::optional<models::SurfaceLayout>& surface = surfaces_[image];
  if (!surface) {
    const traces::Image& i = stream_.images[image];
    surface = models::allocate_surface(memory_, i.width, i.height, i.samples, models::format_bytes(i.format));
    surface_bytes_ += surface->bytes();
  }
  return *surface;
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
    if (!stream_.images[i].is_attachment()) texture(i).fill->need();
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
