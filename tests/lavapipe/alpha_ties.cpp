/// Which pixels hang on an alpha next to its cut-off?
#include "tests/lavapipe/alpha_ties.h"

#include <cstring>
#include <set>
#include <utility>

namespace quadrille::lavapipe {
namespace {

constexpr std::uint32_t kMaterialSet = 1, kMaterialBinding = 0;
constexpr std::size_t kCutoffOffset = 28;  // bytes: the w of the block's second vec4
constexpr float kStep = 1.0f / 255.0f;

}  // namespace

traces::CommandStream with_cutoffs_moved(const traces::CommandStream& stream, float delta) {
  traces::CommandStream moved = stream;
  std::set<std::pair<traces::Index, std::uint32_t>> seen;  // (buffer, offset): materials may share a block
  for (const traces::Command& command : stream.commands) {
    const auto* bind = std::get_if<traces::BindDescriptorSet>(&command);
    if (bind == nullptr || bind->set != kMaterialSet) continue;
    for (const traces::UniformBinding& uniform : stream.descriptor_sets[bind->descriptors].uniforms) {
      if (uniform.binding != kMaterialBinding || uniform.range < kCutoffOffset + sizeof(float)) continue;
      if (!seen.emplace(uniform.buffer, uniform.offset).second) continue;
      std::byte* place = moved.buffers[uniform.buffer].data.data() + uniform.offset + kCutoffOffset;
      float cutoff = 0;
      std::memcpy(&cutoff, place, sizeof cutoff);
      cutoff += delta;
      std::memcpy(place, &cutoff, sizeof cutoff);
    }
  }
  return moved;
}

std::vector<std::uint8_t> alpha_ties(const traces::CommandStream& triangles, const Rendered& base,
                                     const Renderer& render) {
  std::vector<std::uint8_t> ties(base.color.size(), 0);
  for (const float delta : {-kStep, kStep}) {
    const Rendered moved = render(with_cutoffs_moved(triangles, delta));
    for (std::size_t i = 0; i < ties.size(); ++i)
      if (moved.color[i] != base.color[i]) ties[i] = 1;
  }
  return ties;
}

}  // namespace quadrille::lavapipe
