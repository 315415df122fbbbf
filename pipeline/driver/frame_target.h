/// What a frame in device memory depends on beside its command stream and the precision of its machine.
/// Pictures do not depend on it.
#pragma once

#include "models/texture/layout.h"
#include "pipeline/compiler/target.h"

namespace quadrille::pipeline {

struct FrameTarget {
  ShaderTarget shaders;
  models::Tiling textures = models::Tiling::kTiled;
};

}  // namespace quadrille::pipeline
