/// The field lists of the command stream's types, which a writer and a reader walk (trace_archive.h).
#include "traces/trace_codec.h"

#include <tuple>
#include <utility>

#include "models/base/error.h"
#include "traces/trace_archive.h"

namespace quadrille::traces {
namespace {

template <class... T, class A>
void numbers(A& a, T&... values) {
  (a.number(values), ...);
}

template <class A>
void transfer(A& a, Buffer& v) {
  a.text(v.name);
  a.array(v.data);
}

template <class A>
void transfer(A& a, Image& v) {
  a.text(v.name);
  a.choice(v.format, kLastFormat);
  numbers(a, v.width, v.height, v.levels);
  a.array(v.texels);
  if (a.version() >= 2) numbers(a, v.usage);
  if (a.version() >= 3) numbers(a, v.samples);
  if (a.version() >= 4) numbers(a, v.layers);
  if (a.version() < 5) return;
  a.choice(v.kind, ImageKind::k3D);
  numbers(a, v.depth);
}

template <class A>
void transfer(A& a, Sampler& v) {
  for (Filter* filter : {&v.mag, &v.min, &v.mip}) a.choice(*filter, Filter::kLinear);
  for (Wrap* wrap : {&v.wrap_u, &v.wrap_v}) a.choice(*wrap, models::kLastWrap);
  numbers(a, v.lod_bias, v.min_lod, v.max_lod);
  if (a.version() >= 2) a.choice(v.border, models::kLastBorder);
  if (a.version() < 3) return;
  a.choice(v.wrap_w, models::kLastWrap);
  a.choice(v.compare, CompareOp::kAlways);
  numbers(a, v.max_anisotropy, v.seamless);
  if (a.version() >= 4)
    for (std::uint32_t& bits : v.border_bits) numbers(a, bits);
}

template <class A>
void transfer(A& a, Shader& v) {
  a.text(v.name);
  a.choice(v.stage, ShaderStage::kFragment);
  a.array(v.spirv);
}

template <class A>
void transfer(A& a, BlendState& v) {
  numbers(a, v.enable);
  for (BlendFactor* factor : {&v.src_color, &v.dst_color, &v.src_alpha, &v.dst_alpha})
    a.choice(*factor, a.version() >= 4 ? models::kLastBlendFactor : BlendFactor::kOneMinusDstAlpha);
  for (BlendOp* op : {&v.color, &v.alpha}) a.choice(*op, BlendOp::kMax);
  numbers(a, v.write_mask);
}

template <class A>
void transfer(A& a, StencilFace& v) {
  a.choice(v.compare, CompareOp::kAlways);
  for (StencilOp* op : {&v.fail, &v.pass, &v.depth_fail}) a.choice(*op, StencilOp::kDecrementWrap);
  numbers(a, v.compare_mask, v.write_mask, v.reference);
}

/// What pipelines have since version 4.
template <class A>
void transfer_tests(A& a, Pipeline& v) {
  numbers(a, v.depth_bias.enable, v.depth_bias.constant, v.depth_bias.slope, v.depth_bias.clamp);
  numbers(a, v.depth_bounds.test, v.depth_bounds.least, v.depth_bounds.most, v.stencil.test);
  transfer(a, v.stencil.front);
  transfer(a, v.stencil.back);
  numbers(a, v.blend_shared.constants, v.blend_shared.logic);
  a.choice(v.blend_shared.logic_op, LogicOp::kSet);
}

template <class A>
void transfer(A& a, Pipeline& v) {
  a.text(v.name);
  numbers(a, v.vertex_shader, v.fragment_shader);
  a.table(v.bindings, [&](VertexBinding& b) { numbers(a, b.binding, b.stride, b.per_instance); });
  a.table(v.attributes, [&](VertexAttribute& t) {
    numbers(a, t.location, t.binding);
    a.choice(t.format, kLastFormat);
    numbers(a, t.offset);
  });
  a.choice(v.topology, a.version() >= 3 ? Topology::kLineStrip : Topology::kTriangleFan);
  if (a.version() >= 3) {
    numbers(a, v.primitive_restart);
    a.choice(v.polygon_mode, PolygonMode::kPoint);
    a.choice(v.line_mode, LineMode::kSmooth);
    numbers(a, v.line_width);
  }
  a.choice(v.cull, CullMode::kBack);
  a.choice(v.front, FrontFace::kClockwise);
  numbers(a, v.depth_clamp, v.depth.test, v.depth.write);
  a.choice(v.depth.compare, CompareOp::kAlways);
  const std::size_t blends = a.version() >= 2 ? v.blend.size() : 1;
  for (std::size_t i = 0; i < blends; ++i) transfer(a, v.blend[i]);
  if (a.version() < 4) return;
  numbers(a, v.sample_shading, v.alpha_to_coverage, v.sample_mask);
  transfer_tests(a, v);
  if (a.version() >= 5) numbers(a, v.order_independent);
  if (a.version() >= 6) numbers(a, v.viewports);
}

template <class A>
void transfer(A& a, DescriptorSet& v) {
  a.table(v.uniforms, [&](UniformBinding& u) { numbers(a, u.binding, u.buffer, u.offset, u.range); });
  a.table(v.textures, [&](TextureDescriptor& t) {
    numbers(a, t.binding, t.image, t.sampler);
    if (a.version() >= 3) numbers(a, t.first_level, t.levels, t.layer);
    if (a.version() < 4) return;
    a.choice(t.view, models::kLastViewKind);
    numbers(a, t.layers);
    for (models::ComponentSource& c : t.components) a.choice(c, models::ComponentSource::kOne);
  });
  if (a.version() >= 2)
    a.table(v.buffers, [&](StorageBinding& b) { numbers(a, b.binding, b.buffer, b.offset, b.range); });
  if (a.version() >= 4) a.table(v.samplers, [&](SamplerDescriptor& s) { numbers(a, s.binding, s.sampler); });
}

template <class A>
void transfer(A& a, OldTarget& v) {
  numbers(a, v.width, v.height);
  a.choice(v.color, kLastFormat);
  a.choice(v.depth, kLastFormat);
}

template <class A>
void transfer(A& a, AttachmentUse& v) {
  numbers(a, v.image);
  a.choice(v.load, LoadOp::kDontCare);
  a.choice(v.store, StoreOp::kDiscard);
  if (a.version() >= 7) numbers(a, v.level, v.layer);
}

template <class A>
void fields_of_version_1(A& a, BeginPass& v) {
  if constexpr (A::kReads) {
    Index target = 0;
    v.colors.resize(1);
    numbers(a, target, v.colors[0].clear, v.depth.clear);
    std::tie(v.colors[0].image, v.depth.image) = a.target(target);
  }
}

template <class A>
void fields(A& a, BeginPass& v) {
  if (a.version() == 1) return fields_of_version_1(a, v);
  a.table(v.colors, [&](ColorAttachmentUse& color) {
    transfer(a, static_cast<AttachmentUse&>(color));
    numbers(a, color.clear);
    if (a.version() >= 3) numbers(a, color.resolve);
    if (a.version() >= 6) numbers(a, color.clear_integers);
    if (a.version() >= 7) numbers(a, color.resolve_level, color.resolve_layer);
  });
  transfer(a, static_cast<AttachmentUse&>(v.depth));
  numbers(a, v.depth.clear);
  if (a.version() >= 4) numbers(a, v.depth.clear_stencil);
  if (a.version() < 5) return;
  a.choice(v.transparency.mode, Transparency::kKbuffer);
  numbers(a, v.transparency.layers);
}
template <class A>
void fields(A&, EndPass&) {}
template <class A>
void fields(A& a, BindPipeline& v) {
  numbers(a, v.pipeline);
}
template <class A>
void fields(A& a, BindDescriptorSet& v) {
  numbers(a, v.set, v.descriptors);
}
template <class A>
void fields(A& a, BindVertexBuffer& v) {
  numbers(a, v.binding, v.buffer, v.offset);
}
template <class A>
void fields(A& a, BindIndexBuffer& v) {
  numbers(a, v.buffer, v.offset);
  a.choice(v.type, IndexType::kUint32);
}
template <class A>
void fields(A& a, PushConstants& v) {
  numbers(a, v.offset);
  a.array(v.data);
}
template <class A>
void fields(A& a, SetViewport& v) {
  numbers(a, v.x, v.y, v.width, v.height, v.min_depth, v.max_depth);
  if (a.version() >= 8) numbers(a, v.index);
}
template <class A>
void fields(A& a, SetScissor& v) {
  numbers(a, v.x, v.y, v.width, v.height);
  if (a.version() >= 8) numbers(a, v.index);
}
template <class A>
void fields(A& a, Draw& v) {
  numbers(a, v.indexed, v.count, v.first, v.vertex_offset, v.instances, v.first_instance);
  a.text(v.label);
}

template <class A>
void fields(A& a, BeginQuery& v) {
  numbers(a, v.pool, v.query, v.precise);
}
template <class A>
void fields(A& a, EndQuery& v) {
  numbers(a, v.pool, v.query);
}

template <class A>
void transfer(A& a, QueryPool& v) {
  a.text(v.name);
  a.choice(v.type, QueryType::kPipelineStatistics);
  numbers(a, v.statistics, v.queries);
}

/// Makes the alternative with number `kind` the active one.
template <std::size_t I = 0>
void emplace(Command& command, std::size_t kind) {
  if constexpr (I < std::variant_size_v<Command>) {
    if (kind == I) {
      command.emplace<I>();
    } else {
      emplace<I + 1>(command, kind);
    }
  }
}

template <class A>
void transfer(A& a, Command& v) {
  auto kind = static_cast<std::uint8_t>(v.index());
  a.number(kind);
  if constexpr (A::kReads) {
    if (kind >= std::variant_size_v<Command>)
      throw user_error("{}: command kind {} is unknown", a.place(), kind);
    emplace(v, kind);
  }
  std::visit([&](auto& command) { fields(a, command); }, v);
}

template <class A>
void transfer(A& a, CommandStream& s, Chunk chunk) {
  const auto table = [&](auto& values) { a.table(values, [&](auto& value) { transfer(a, value); }); };
  switch (chunk) {
    case Chunk::kName: return a.text(s.name);
    case Chunk::kBuffers: return table(s.buffers);
    case Chunk::kImages: return table(s.images);
    case Chunk::kSamplers: return table(s.samplers);
    case Chunk::kShaders: return table(s.shaders);
    case Chunk::kPipelines: return table(s.pipelines);
    case Chunk::kDescriptorSets: return table(s.descriptor_sets);
    case Chunk::kTargets: return;  // not part of a stream any more
    case Chunk::kCommands:
      if (a.version() >= 5) table(s.query_pools);
      return table(s.commands);
  }
}

}  // namespace

std::vector<std::byte> encode_chunk(const CommandStream& stream, Chunk chunk) {
  Writer writer(kChunks[static_cast<std::size_t>(chunk)].version);
  // The field lists are shared with the reader and so take a mutable stream; the writer only looks at it.
  transfer(writer, const_cast<CommandStream&>(stream), chunk);
  return writer.take();
}

void ChunkReader::decode(CommandStream& stream, Chunk chunk, std::uint32_t version,
                         std::span<const std::byte> payload, const std::string& place) {
  Reader reader(payload, version, place, targets_);
  if (chunk == Chunk::kTargets) {
    std::vector<OldTarget> targets;
    reader.table(targets, [&](OldTarget& target) { transfer(reader, target); });
    for (const OldTarget& t : targets) {
      const BeginPass pass = make_pass(stream, {t.width, t.height, t.color, t.depth});
      targets_.emplace_back(pass.colors[0].image, pass.depth.image);
    }
  } else {
    transfer(reader, stream, chunk);
  }
  reader.finish();
}

}  // namespace quadrille::traces
