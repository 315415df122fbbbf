/// Binding uniforms and textures to a shader.
#include "models/reference/draw_state.h"

#include <cstring>
#include <span>

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"

namespace quadrille::models::reference {
namespace {

const traces::DescriptorSet& descriptor_set(const ShaderProgram& program, const DrawState& state,
                                            std::uint32_t set) {
  const auto found = state.descriptor_sets.find(set);
  if (found == state.descriptor_sets.end())
    throw user_error("draw {}: shader '{}' uses descriptor set {}, which is not bound", state.number,
                     program.name, set);
  return state.stream->descriptor_sets[found->second];
}

/// The bytes of a uniform block: the buffer from the binding's offset, at most its range.
std::span<const std::byte> block_bytes(const ShaderProgram& program, const DrawState& state,
                                       const UniformScalar& scalar) {
  for (const traces::UniformBinding& binding : descriptor_set(program, state, scalar.set).uniforms) {
    if (binding.binding != scalar.binding) continue;
    const std::span<const std::byte> data = state.stream->buffers[binding.buffer].data;
    const std::span<const std::byte> rest = data.subspan(std::min<std::size_t>(binding.offset, data.size()));
    return rest.first(std::min<std::size_t>(binding.range, rest.size()));
  }
  throw user_error("draw {}: shader '{}' uses uniform block (set {}, binding {}), which is not bound",
                   state.number, program.name, scalar.set, binding_text(scalar.binding));
}

void set_uniform(Cell& cell, std::span<const std::byte> bytes, const UniformScalar& scalar) {
  std::uint32_t word = 0;
  if (std::size_t{scalar.byte_offset} + 4 <= bytes.size())
    std::memcpy(&word, bytes.data() + scalar.byte_offset, 4);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (scalar.kind == ScalarKind::kFloat) {
      cell.set_f(lane, static_cast<double>(std::bit_cast<float>(word)));
    } else {
      cell.set_u(lane, word);
    }
  }
}

/// The texture's, or that at a binding of its own; any for one that is used without.
const traces::Sampler* sampler_of(const ShaderProgram& program, const DrawState& state, const TextureUse& use,
                                  const traces::TextureDescriptor& texture) {
  static const traces::Sampler kAny{};
  if (is_multisampled(texture.view)) return &kAny;  // single samples are fetched
  if (!use.separate) return &state.stream->samplers.at(texture.sampler);
  if (use.sampler_binding == TextureUse{}.sampler_binding) return &kAny;
  for (const traces::SamplerDescriptor& s : descriptor_set(program, state, use.sampler_set).samplers)
    if (s.binding == use.sampler_binding) return &state.stream->samplers.at(s.sampler);
  throw user_error("draw {}: shader '{}' uses sampler (set {}, binding {}), which is not bound", state.number,
                   program.name, use.sampler_set, binding_text(use.sampler_binding));
}

TextureView texture_view(const ShaderProgram& program, const DrawState& state, const TextureUse& use,
                         const Precision* precision) {
  for (const traces::TextureDescriptor& texture : descriptor_set(program, state, use.set).textures) {
    if (texture.binding != use.binding) continue;
    TextureView view;
    const traces::Image& image = state.stream->images[texture.image];
    const auto unpacked = state.unpacked->find(texture.image);
    view.image = unpacked != state.unpacked->end() ? &unpacked->second : &image;
    view.precision = precision;
    view.first_level = texture.first_level;
    view.levels = traces::level_count(*state.stream, texture);
    view.channels = models::format_info(image.format).channels;
    view.kind = texture.view;
    view.first_layer = texture.layer;
    view.layers = texture.layers;
    view.components = texture.components;
    for (std::uint32_t layer = 0; image.is_attachment() && layer < texture.layers; ++layer) {
      const auto drawn = state.drawn->find({texture.image, texture.layer + layer});
      if (drawn == state.drawn->end())
        throw user_error("draw {}: shader '{}' samples image '{}' before a pass has drawn it", state.number,
                         program.name, image.name);
      view.drawn.push_back(&drawn->second);
    }
    view.sampler = sampler_of(program, state, use, texture);
    return view;
  }
  throw user_error("draw {}: shader '{}' uses texture (set {}, binding {}), which is not bound", state.number,
                   program.name, use.set, binding_text(use.binding));
}

}  // namespace

Lanes BoundShader::lanes() const {
  Lanes lanes;
  lanes.cells = cells;
  lanes.textures = &textures;
  lanes.instructions = &program->texture_instructions;
  return lanes;
}

BoundShader bind_shader(const ShaderProgram& program, const DrawState& state, const Precision* precision) {
  BoundShader bound{&program, program.initial, {}};
  const UniformScalar* before = nullptr;
  std::span<const std::byte> bytes;
  for (const UniformScalar& scalar : program.uniforms) {
    if (before == nullptr || before->push != scalar.push || before->set != scalar.set ||
        before->binding != scalar.binding) {
      bytes = scalar.push ? std::span<const std::byte>(state.push_constants)
                          : block_bytes(program, state, scalar);
      before = &scalar;
    }
    set_uniform(bound.cells[scalar.slot], bytes, scalar);
  }
  for (const TextureUse& use : program.textures)
    bound.textures.push_back(texture_view(program, state, use, precision));
  return bound;
}

}  // namespace quadrille::models::reference
