/// What each texture of a frame was asked for and took (hw/texture/texture_use.h), and the laws that hold the
/// sums to what units and channels count.
#pragma once

#include "hw/texture/texture_use.h"
#include "pipeline/driver/sampled_image.h"

#include <cstdint>

namespace quadrille::pipeline {

class Machine;
struct DeviceFrame;
struct Figures;

struct TextureFigures {
  SampledImage image;
  hw::TextureUse use;              ///< of all texture units
  std::uint64_t memory_bytes = 0;  ///< that memory read for the texture units
};

/// Before the run: units and channels keep counts by texture. Pixels and cycles stay the same.
void keep_texture_use(const Machine& machine, const DeviceFrame& frame);
/// After the run: adds `textures` to the figures, and their laws.
void collect_texture_use(const Machine& machine, const DeviceFrame& frame, Figures& figures);

}  // namespace quadrille::pipeline
