/// What is bound when a draw is executed, and shaders with their uniforms and textures in place. Internal to
/// the reference.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "models/reference/shader_program.h"
#include "traces/command_stream.h"

namespace quadrille::models::reference {

struct VertexBuffer {
  traces::Index buffer = traces::kNone;
  std::uint64_t offset = 0;
};

/// A colour attachment, row by row: pixels as stored, and 4 linear values for each, before they were rounded;
/// of several samples, those of a pixel one after the other.
struct ColorTarget {
  traces::Format format = traces::Format::kR8G8B8A8Unorm;
  std::vector<PixelCode> code;
  std::vector<double> linear;
};

/// A fragment of an order-independent draw: its colour multiplied by its alpha.
struct KeptFragment {
  double depth = 0;
  std::array<double, 4> color{};
};
using KeptFragments = std::vector<KeptFragment>;

/// Layers of attachments, each with all its levels as texels. Those of several samples have one level, and
/// the samples of a pixel follow each other.
using DrawnLayers = std::map<std::pair<traces::Index, std::uint32_t>, traces::Image>;
/// Images of compressed blocks, with their texels.
using UnpackedImages = std::map<traces::Index, traces::Image>;

struct DrawState {
  const traces::CommandStream* stream = nullptr;
  std::vector<ColorTarget*> colors;              ///< of the pass, by attachment
  std::vector<double>* depth = nullptr;          ///< of the pass; null: it has no depth attachment
  std::vector<std::uint8_t>* stencil = nullptr;  ///< beside `depth`
  traces::Format depth_format = traces::Format::kD32Float;
  std::uint32_t samples = 1;  ///< a pixel, of the pass
  /// of a pass that keeps fragments: by place, as colours
  std::vector<KeptFragments>* kept = nullptr;
  /// what earlier passes have drawn, by image and layer, with texels, for samplers
  const DrawnLayers* drawn = nullptr;
  const UnpackedImages* unpacked = nullptr;
  const traces::Pipeline* pipeline = nullptr;
  std::map<std::uint32_t, traces::Index> descriptor_sets;
  std::map<std::uint32_t, VertexBuffer> vertex_buffers;
  traces::BindIndexBuffer index_buffer;
  std::vector<std::byte> push_constants = std::vector<std::byte>(traces::kMaxPushConstantBytes);
  std::array<traces::SetViewport, kMaxViewports> viewports;
  std::array<traces::SetScissor, kMaxViewports> scissors;
  const traces::Draw* draw = nullptr;
  std::uint32_t number = 0;  ///< of the draw in the stream, from 0
};

/// A shader ready to run: `cells` hold constants and uniforms. A thread runs on a copy (`lanes`).
struct BoundShader {
  const ShaderProgram* program = nullptr;
  std::vector<Cell> cells;
  std::vector<TextureView> textures;

  [[nodiscard]] Lanes lanes() const;
};

/// Copies uniforms and push constants into a shader's cells and looks up its textures. Bytes beyond a range
/// or buffer read as zero. `precision`: null in mode
/// *ideal*. Throws `UserError` if a descriptor the shader uses is not bound.
[[nodiscard]] BoundShader bind_shader(const ShaderProgram& program, const DrawState& state,
                                      const Precision* precision);

}  // namespace quadrille::models::reference
