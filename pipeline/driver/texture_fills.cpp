#include "pipeline/driver/texture_fills.h"

#include <chrono>

#include "pipeline/driver/host_cost.h"

namespace quadrille::pipeline {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

models::TextureFill& TextureFills::add(const traces::Image& image, const models::TextureView& view) {
  const auto tile = [this, view, packed = image.packed, unpacked = &image] {
    const Clock::time_point start = Clock::now();
    const double cpu = pipeline::cpu_seconds();
    if (packed)
      (*packed)([&](std::uint32_t level, std::span<const std::byte> texels) {
        models::tile_level(memory_, view, level, texels);
      });
    else models::tile_texture(memory_, view, unpacked->texels);
    seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
    cpu_seconds_ += pipeline::cpu_seconds() - cpu;
  };
  const models::FormatInfo& info = models::format_info(image.format);
  const std::uint64_t texels = traces::texel_bytes(image) / info.bytes * info.block_width * info.block_height;
  entries_.push_back({models::TextureFill(tile), texels});
  return entries_.back().fill;
}

TextureFills::Pending TextureFills::pending() const {
  Pending pending;
  for (const Entry& entry : entries_) {
    if (!entry.fill.pending()) continue;
    ++pending.textures;
    pending.texels += entry.texels;
  }
  return pending;
}

}  // namespace quadrille::pipeline
