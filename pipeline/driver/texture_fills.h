/// The textures of a frame whose texels come when they are first sampled, what that cost, and which never
/// came.
#pragma once

#include <cstdint>
#include <deque>

#include "models/memory/device_memory.h"
#include "models/texture/layout.h"
#include "models/texture/texture_fill.h"
#include "traces/command_stream.h"

namespace quadrille::pipeline {

class TextureFills {
 public:
  explicit TextureFills(models::DeviceMemory& memory) : memory_(memory) {}
  TextureFills(const TextureFills&) = delete;
  TextureFills& operator=(const TextureFills&) = delete;

  /// The image's texels, to be tiled where `view` says. The image must outlive this, or be packed. Filling
  /// throws `UserError` for an image that cannot be unpacked.
  models::TextureFill& add(const traces::Image& image, const models::TextureView& view);

  /// Textures that nothing has sampled, and their texels with all mip levels.
  struct Pending {
    std::uint64_t textures = 0, texels = 0;
  };
  [[nodiscard]] Pending pending() const;
  /// Seconds that unpacking and tiling took, by the clock and of processor time.
  [[nodiscard]] double seconds() const { return seconds_; }
  [[nodiscard]] double cpu_seconds() const { return cpu_seconds_; }

 private:
  struct Entry {
    models::TextureFill fill;
    std::uint64_t texels = 0;
  };
  models::DeviceMemory& memory_;
  std::deque<Entry> entries_;  ///< draws point into it
  double seconds_ = 0, cpu_seconds_ = 0;
};

}  // namespace quadrille::pipeline
