/// The field lists of the command stream's types, and the writer and reader that walk them.
#include "traces/trace_codec.h"

#include <bit>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "models/base/error.h"

namespace quadrille::traces {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the trace file is little-endian and is copied as it lies in memory");

// of one table: bounds what a hostile count can make us allocate
constexpr std::uint64_t kMaxElements = std::uint64_t{1} << 23;

class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(std::uint32_t version) : version_(version) {}
  [[nodiscard]] std::uint32_t version() const { return version_; }
  template <class T>
  void number(const T& value) {
    append(&value, sizeof(T));
  }
  template <class E>
  void choice(const E& value, E) {
    number(static_cast<std::uint8_t>(value));
  }
  template <class T>
  void array(const std::vector<T>& values) {
    number<std::uint64_t>(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void text(const std::string& value) {
    number<std::uint64_t>(value.size());
    append(value.data(), value.size());
  }
  template <class T, class F>
  void table(std::vector<T>& values, F&& element) {
    number<std::uint64_t>(values.size());
    for (T& value : values) element(value);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + size);
    if (size > 0) std::memcpy(bytes_.data() + end, data, size);
  }
  std::uint32_t version_;
  std::vector<std::byte> bytes_;
};

/// A target of files of version 1: one colour and one depth attachment, of passes that clear and store them.
struct OldTarget {
  std::uint32_t width = 0, height = 0;
  Format color = Format::kUndefined, depth = Format::kUndefined;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  using OldTargets = std::vector<std::pair<Index, Index>>;
  Reader(std::span<const std::byte> bytes, std::uint32_t version, const std::string& place,
         const OldTargets& targets)
      : bytes_(bytes), place_(place), targets_(targets), version_(version) {}
  [[nodiscard]] std::uint32_t version() const { return version_; }
  /// Images of a target, in a file of version 1.
  [[nodiscard]] std::pair<Index, Index> target(Index index) const {
    if (index >= targets_.size()) throw user_error("{}: render target {} does not exist", place_, index);
    return targets_[index];
  }

  template <class T>
  void number(T& value) {
    copy(&value, sizeof(T));
  }
  void number(bool& value) {
    std::uint8_t byte = 0;
    copy(&byte, 1);
    if (byte > 1) throw user_error("{}: byte {} is {} where 0 or 1 is due", place_, at_ - 1, byte);
    value = byte == 1;
  }
  template <class E>
  void choice(E& value, E last) {
    std::uint8_t byte = 0;
    copy(&byte, 1);
    if (byte > static_cast<std::uint8_t>(last))
      throw user_error("{}: byte {} is {}; the largest value there is {}", place_, at_ - 1, byte,
                       static_cast<int>(last));
    value = static_cast<E>(byte);
  }
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t count = length(sizeof(T));
    values.resize(count);
    copy(values.data(), count * sizeof(T));
  }
  void text(std::string& value) {
    value.resize(length(1));
    copy(value.data(), value.size());
  }
  template <class T, class F>
  void table(std::vector<T>& values, F&& element) {
    const std::uint64_t count = length(1);
    if (count > kMaxElements)
      throw user_error("{}: {} elements, the limit is {}", place_, count, kMaxElements);
    values.clear();
    for (std::uint64_t i = 0; i < count; ++i) element(values.emplace_back());
  }
  void finish() const {
    if (at_ != bytes_.size()) throw user_error("{}: {} bytes follow its end", place_, bytes_.size() - at_);
  }
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  /// Reads a count and makes sure that so many elements of `size` bytes can still follow, before anyone
  /// allocates for them.
  std::uint64_t length(std::size_t size) {
    std::uint64_t count = 0;
    number(count);
    if (count > (bytes_.size() - at_) / size)
      throw user_error("{}: {} elements are announced at byte {} where {} bytes remain", place_, count,
                       at_ - 8, bytes_.size() - at_);
    return count;
  }
  void copy(void* target, std::size_t size) {
    if (size > bytes_.size() - at_)
      throw user_error("{}: ends at byte {}, inside a value", place_, bytes_.size());
    if (size > 0) std::memcpy(target, bytes_.data() + at_, size);
    at_ += size;
  }
  std::span<const std::byte> bytes_;
  const std::string& place_;
  const OldTargets& targets_;
  std::uint32_t version_;
  std::size_t at_ = 0;
};

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
}

template <class A>
void transfer(A& a, Sampler& v) {
  for (Filter* filter : {&v.mag, &v.min, &v.mip}) a.choice(*filter, Filter::kLinear);
  for (Wrap* wrap : {&v.wrap_u, &v.wrap_v}) a.choice(*wrap, Wrap::kClampToEdge);
  numbers(a, v.lod_bias, v.min_lod, v.max_lod);
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
}

template <class A>
void transfer(A& a, DescriptorSet& v) {
  a.table(v.uniforms, [&](UniformBinding& u) { numbers(a, u.binding, u.buffer, u.offset, u.range); });
  a.table(v.textures, [&](TextureDescriptor& t) { numbers(a, t.binding, t.image, t.sampler); });
  if (a.version() >= 2)
    a.table(v.buffers, [&](StorageBinding& b) { numbers(a, b.binding, b.buffer, b.offset, b.range); });
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
}
template <class A>
void fields(A& a, SetScissor& v) {
  numbers(a, v.x, v.y, v.width, v.height);
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
