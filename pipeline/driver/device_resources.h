/// Buffers and images of a command stream in device memory: each is placed when it is first asked for, so
/// that what nothing reads takes no memory. A texture gets its address then, and its texels when something
/// first samples it: they are unpacked, tiled and forgotten.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "models/memory/device_memory.h"
#include "models/memory/surface.h"
#include "models/shader/warp.h"
#include "models/texture/layout.h"
#include "pipeline/driver/texture_fills.h"
#include "traces/command_stream.h"

namespace quadrille::pipeline {

/// What programs are told of the size of a texture.
[[nodiscard]] models::TextureSize size_of(const traces::CommandStream& stream,
                                          const traces::TextureDescriptor& bound);

class DeviceResources {
 public:
  /// Takes room for everything in the stream, its attachments too, so that growing never copies what is
  /// there. Textures lie in the order of `tiling`.
  DeviceResources(const traces::CommandStream& stream, models::DeviceMemory& memory, TextureFills& fills,
                  models::Tiling tiling);
  /// Address of a buffer's first byte; it is aligned to a line.
  [[nodiscard]] std::uint64_t buffer(traces::Index index);
  struct Texture {
    models::TextureView view;
    models::TextureFill* fill = nullptr;
  };
  /// For a sampler: the levels that it sees. Those of an attachment lie where passes draw them.
  [[nodiscard]] Texture texture(const traces::TextureDescriptor& bound);
  /// For a pass.
  [[nodiscard]] const models::SurfaceLayout& attachment(const traces::ImagePart& part);
  /// A surface that is no image of the stream.
  [[nodiscard]] models::SurfaceLayout surface(const models::SurfaceLayout& wanted);
  /// Places buffers and textures that nobody asked for, behind all else, so that no address depends on it,
  /// and brings all texels. Throws `UserError`.
  void place_rest();

  [[nodiscard]] std::uint64_t buffer_bytes() const { return buffer_bytes_; }
  [[nodiscard]] std::uint64_t texture_bytes() const { return texture_bytes_; }
  [[nodiscard]] std::uint64_t surface_bytes() const { return surface_bytes_; }
  struct Unplaced {
    std::size_t images = 0, bytes = 0;
  };
  [[nodiscard]] Unplaced unplaced_images() const;

 private:
  /// A texture, with all its levels.
  [[nodiscard]] const Texture& whole_texture(traces::Index image);
  /// The levels of a layer of an attachment, finest first.
  [[nodiscard]] std::span<const models::SurfaceLayout> layer(traces::Index index, std::uint32_t layer);
  /// Places a level of a layer, behind those that are placed, and brings the texels that it begins with.
  void place_level(const traces::Image& image, std::uint32_t layer, std::uint32_t level,
                   std::vector<models::SurfaceLayout>& surfaces);

  const traces::CommandStream& stream_;
  models::DeviceMemory& memory_;
  TextureFills& fills_;
  models::Tiling tiling_;
  std::vector<std::optional<std::uint64_t>> buffers_;
  std::vector<std::optional<Texture>> textures_;
  /// By image: the levels of its layers, those of a layer one behind the other; none: not placed.
  std::vector<std::vector<models::SurfaceLayout>> surfaces_;
  std::uint64_t buffer_bytes_ = 0, texture_bytes_ = 0, surface_bytes_ = 0;
};

}  // namespace quadrille::pipeline
