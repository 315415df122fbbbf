#include "pipeline/driver/frame_builder.h"

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "pipeline/driver/attachment_lives.h"
#include "pipeline/driver/device_resources.h"
#include "pipeline/driver/fixed_function.h"
#include "pipeline/driver/transparency.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <tuple>

namespace quadrille::pipeline {

namespace {

using traces::Index;
using traces::kNone;

class FrameBuilder {
 public:
  FrameBuilder(const traces::CommandStream& stream, const models::Precision& precision,
               const FrameTarget& target, DeviceFrame& out)
      : stream_(stream),
        target_(target.shaders),
        out_(out),
        resources_(stream, out.memory, out.fills, target.textures),
        storage_(stream, resources_),
        lives_(stream),
        queries_(stream.query_pools) {
    out.frame.precision = precision;
    out.frame.storage = &out.storage;
  }

  void build(bool leave_out) {
    for (const traces::Command& command : stream_.commands) {
      std::visit([this](const auto& c) { apply(c); }, command);
    }
    out_.written_buffers = storage_.finish(out_.frame, out_.storage);
    out_.queries = queries_.ranges();
    out_.sampled = sampled_.all();
    if (!leave_out) resources_.place_rest();
    out_.buffer_bytes = resources_.buffer_bytes();
    out_.texture_bytes = resources_.texture_bytes();
    out_.surface_bytes = resources_.surface_bytes();
    note_left_out();
  }

 private:
  void apply(const traces::BeginPass& c) {
    begun_ = &c;
    const traces::PassTarget target = traces::target_of(stream_, c);
    hw::PassState pass;
    pass.width = target.width;
    pass.height = target.height;
    for (const traces::ColorAttachmentUse& use : c.colors) {
      hw::AttachmentState& color = pass.color[pass.colors++];
      color = attachment(use);
      if (use.load == traces::LoadOp::kClear)
        color.clear = models::is_integer_format(color.format)
                          ? models::encode_integers(color.format, use.clear_integers)
                          : models::encode_color(color.format, use.clear);
      if (use.resolve == traces::kNone) continue;
      hw::AttachmentState& resolve = pass.resolve[pass.colors - 1];
      resolve = attachment({use.resolve, traces::LoadOp::kLoad, traces::StoreOp::kStore, use.resolve_level,
                            use.resolve_layer});
      pass.resolved |= 1u << (pass.colors - 1);
    }
    pass.samples = static_cast<int>(stream_.images[c.first_image()].samples);
    if (c.depth.image != kNone)
      pass.clear_depth =
          c.depth.load == traces::LoadOp::kClear ? models::round_depth(depth_format(), c.depth.clear) : 0;
    pass.first_draw = hw::DrawId(out_.frame.draws.size());
    out_.frame.passes.push_back(pass);
    scissors_.fill({0, 0, static_cast<std::int32_t>(target.width), static_cast<std::int32_t>(target.height)});
    viewports_.fill({0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0, 1});
  }
  void apply(const traces::EndPass&) {
    hw::PassState& pass = out_.frame.passes.back();
    const bool attached = begun_->depth.image != kNone;
    out_.shown_has_depth = attached;
    pass.draws = static_cast<std::uint32_t>(out_.frame.draws.size()) - pass.first_draw.index();
    place_transparency(begun_->transparency, out_.frame.draws_of(pass), resources_, pass);
    if (!attached) return;
    const bool tests =
        std::ranges::any_of(out_.frame.draws_of(pass), [](const hw::DrawState& d) { return d.uses_depth(); });
    const bool kept = lives_.read_after(begun_->depth.part(), out_.frame.passes.size() - 1);
    if (tests || kept) {
      pass.has_depth = true;
      pass.depth = attachment(begun_->depth);
      pass.depth.read_later = kept;
      const bool clears = begun_->depth.load == traces::LoadOp::kClear;
      pass.depth.clear = models::encode_depth(pass.depth.format, pass.clear_depth,
                                              clears ? begun_->depth.clear_stencil : std::uint8_t{0});
    } else {
      out_.left_out.push_back(
          {"depth surface", "no draw of the pass tests depth",
           fmt::format("{} bytes of device memory",
                       traces::level_bytes(stream_.images[begun_->depth.image], begun_->depth.level))});
    }
  }
  /// Of the pass; kUndefined: it has no depth attachment.
  [[nodiscard]] models::Format depth_format() const {
    return begun_->depth.image == kNone ? models::Format::kUndefined
                                        : stream_.images[begun_->depth.image].format;
  }
  hw::AttachmentState attachment(const traces::AttachmentUse& use) {
    return {
        resources_.attachment(use.part()), stream_.images[use.image].format, use.load, use.store, {}, true};
  }
  void apply(const traces::BindPipeline& c) { pipeline_ = c.pipeline; }
  void apply(const traces::BindDescriptorSet& c) { sets_[c.set] = c.descriptors; }
  void apply(const traces::BindVertexBuffer& c) { vertex_buffers_[c.binding] = c; }
  void apply(const traces::BindIndexBuffer& c) { index_buffer_ = c; }
  void apply(const traces::PushConstants& c) {
    if (push_.size() < c.offset + c.data.size()) push_.resize(c.offset + c.data.size());
    std::copy(c.data.begin(), c.data.end(), push_.begin() + c.offset);
  }
  void apply(const traces::SetViewport& c) {
    viewports_[c.index] = {c.x, c.y, c.width, c.height, c.min_depth, c.max_depth};
  }
  void apply(const traces::SetScissor& c) {
    scissors_[c.index] = {c.x, c.y, c.x + static_cast<std::int32_t>(c.width),
                          c.y + static_cast<std::int32_t>(c.height)};
  }
  void apply(const traces::BeginQuery& c) { queries_.begin(c, out_.frame.draws.size()); }
  void apply(const traces::EndQuery& c) { queries_.end(c, out_.frame.draws.size()); }
  void apply(const traces::Draw& c) {
    const traces::Pipeline& pipeline = stream_.pipelines[pipeline_];
    const CompiledPipeline& programs = compiled(pipeline_);
    hw::DrawState draw;
    draw.label = c.label;
    draw.pass = hw::PassId(out_.frame.passes.size() - 1);
    draw.vertex.program = &programs.vertex;
    draw.fragment.program = &programs.fragment;
    geometry(c, pipeline, draw);
    attributes(pipeline, programs.integer_inputs, draw);
    set_fixed_function({pipeline, out_.frame.passes.back(), depth_format(), viewports_, scissors_,
                        out_.frame.precision.subpixel_bits},
                       draw);
    draw.counts_samples = queries_.counts_samples();
    draw.vertex.constants = constants(programs.vertex);
    draw.fragment.constants = constants(programs.fragment);
    textures(programs.vertex, draw.vertex.textures, draw.vertex.texture_sizes);
    textures(programs.fragment, draw.fragment.textures, draw.fragment.texture_sizes);
    storage_.bind(draw.vertex, sets_);
    storage_.bind(draw.fragment, sets_);
    out_.frame.draws.push_back(std::move(draw));
  }

  const CompiledPipeline& compiled(Index index) {
    const traces::Pipeline& pipeline = stream_.pipelines[index];
    const bool points =
        models::PrimitiveState{models::assembled_kind(pipeline.topology), pipeline.polygon_mode}.pieces() ==
        models::PieceKind::kPoint;
    const auto key = std::tuple{pipeline.vertex_shader, pipeline.fragment_shader, points};
    const auto found = programs_.find(key);
    if (found != programs_.end()) return *found->second;
    const traces::Shader& vertex = stream_.shaders[pipeline.vertex_shader];
    const traces::Shader& fragment = stream_.shaders[pipeline.fragment_shader];
    out_.programs.push_back(
        compile_pipeline(vertex.spirv, vertex.name, fragment.spirv, fragment.name, target_, points));
    programs_[key] = &out_.programs.back();
    return out_.programs.back();
  }

  void geometry(const traces::Draw& c, const traces::Pipeline& pipeline, hw::DrawState& draw) {
    draw.topology = pipeline.topology;
    draw.restarts = pipeline.primitive_restart && c.indexed;
    draw.indexed = c.indexed;
    draw.count = c.count;
    draw.instances = c.instances;
    draw.first_instance = c.first_instance;
    draw.vertex_offset = c.vertex_offset;
    draw.first_vertex = c.first;
    if (c.indexed) {
      draw.index_bytes = 1u << static_cast<int>(index_buffer_.type);
      draw.index_address = resources_.buffer(index_buffer_.buffer) + index_buffer_.offset +
                           std::uint64_t{c.first} * draw.index_bytes;
      storage_.note_read(index_buffer_.buffer, "an index buffer");
    }
  }

  void attributes(const traces::Pipeline& pipeline, std::uint32_t integer_inputs, hw::DrawState& draw) {
    const auto& uses = draw.vertex.program->vertex_inputs;
    for (const traces::VertexAttribute& attribute : pipeline.attributes) {
      hw::AttributeFetch fetch;
      bool used = false;
      for (std::size_t row = 0; row < uses.size(); ++row) {
        if (uses[row].location != attribute.location) continue;
        fetch.input_row[uses[row].component] = static_cast<int>(row);
        used = true;
      }
      if (!used) {
        ++unread_attributes_;
        continue;
      }
      const bool integers = (integer_inputs >> attribute.location & 1u) != 0;
      if (integers != traces::is_integer_format(attribute.format)) {
        throw user_error("{}: reads vertex input location {} as {}, which pipeline '{}' supplies as {}",
                         draw.vertex.program->name, attribute.location, integers ? "integers" : "floats",
                         pipeline.name, integers ? "floats" : "integers");
      }
      const auto binding =
          std::ranges::find(pipeline.bindings, attribute.binding, &traces::VertexBinding::binding);
      const traces::BindVertexBuffer& bound = vertex_buffers_.at(attribute.binding);
      fetch.address = resources_.buffer(bound.buffer) + bound.offset + attribute.offset;
      storage_.note_read(bound.buffer, "a vertex buffer");
      fetch.stride = binding->stride;
      fetch.per_instance = binding->per_instance;
      fetch.format = attribute.format;
      draw.attributes.push_back(fetch);
    }
    for (const models::VertexInputUse& use : uses) {
      const bool given =
          std::ranges::any_of(pipeline.attributes, [&](const auto& a) { return a.location == use.location; });
      if (!given) {
        throw user_error("{}: reads vertex input location {}, which pipeline '{}' does not supply",
                         draw.vertex.program->name, use.location, pipeline.name);
      }
    }
  }

  std::vector<std::uint32_t> constants(const models::Program& program) {
    std::vector<std::uint32_t> words(program.constants.words);
    for (const models::ConstantLayout::Range& range : program.constants.ranges) {
      std::uint32_t* const to = words.data() + range.first_word;
      switch (range.source) {
        case models::ConstantLayout::Source::kLiteral:
          std::copy(range.literals.begin(), range.literals.end(), to);
          break;
        case models::ConstantLayout::Source::kPushConstant:
          copy_words(push_, range, to, program, [] { return "the push constants"; });
          break;
        case models::ConstantLayout::Source::kUniformBlock: {
          const traces::UniformBinding& bound = uniform(program, range.set, range.binding);
          storage_.note_read(bound.buffer, "a uniform block");
          const auto& data = stream_.buffers[bound.buffer].data;
          const std::span<const std::byte> view = std::span(data).subspan(bound.offset, bound.range);
          copy_words(view, range, to, program, [&] {
            return fmt::format("the uniform block at set {}, binding {}", range.set,
                               models::binding_text(range.binding));
          });
          break;
        }
      }
    }
    return words;
  }

  /// `what` makes the name of `from`, for an error: it would cost more than the copy.
  template <class What>
  static void copy_words(std::span<const std::byte> from, const models::ConstantLayout::Range& range,
                         std::uint32_t* to, const models::Program& program, const What& what) {
    const std::uint64_t end = range.byte_offset + std::uint64_t{4} * range.words;
    if (end > from.size())
      throw user_error("{}: reads {} bytes of {}, which holds {}", program.name, end, what(), from.size());
    std::memcpy(to, from.data() + range.byte_offset, std::size_t{4} * range.words);
  }

  /// What is bound there; null: nothing.
  template <class T>
  const T* bound(std::vector<T> traces::DescriptorSet::*list, std::uint32_t set,
                 std::uint32_t binding) const {
    const auto found = sets_.find(set);
    if (found == sets_.end()) return nullptr;
    const std::vector<T>& all = stream_.descriptor_sets[found->second].*list;
    const auto one = std::ranges::find(all, binding, &T::binding);
    return one == all.end() ? nullptr : &*one;
  }

  const traces::UniformBinding& uniform(const models::Program& program, std::uint32_t set,
                                        std::uint32_t binding) {
    if (const auto* found = bound(&traces::DescriptorSet::uniforms, set, binding)) return *found;
    throw user_error("{}: no uniform buffer is bound at set {}, binding {}", program.name, set,
                     models::binding_text(binding));
  }

  void textures(const models::Program& program, std::vector<hw::TextureState>& states,
                std::vector<models::TextureSize>& sizes) {
    for (const models::TextureBinding& use : program.textures) {
      const traces::TextureDescriptor& bound = texture(program, use.set, use.binding);
      const traces::Image& image = stream_.images[bound.image];
      if (models::number_kind(image.format) != use.texels)
        throw user_error("{}: samples {} from image {} '{}', whose format {} holds {}", program.name,
                         models::name_of(use.texels), bound.image, image.name,
                         models::format_info(image.format).name,
                         models::name_of(models::number_kind(image.format)));
      if (bound.view != use.view)
        throw user_error("{}: samples a view '{}' at set {}, binding {}, where one '{}' is bound",
                         program.name, models::kViewKindNames.at(static_cast<std::size_t>(use.view)), use.set,
                         models::binding_text(use.binding),
                         models::kViewKindNames.at(static_cast<std::size_t>(bound.view)));
      lives_.check_sampled(bound, out_.frame.passes.size() - 1, program.name);
      out_.frame.passes.back().samples_attachments |= image.is_attachment();
      const DeviceResources::Texture texture = resources_.texture(bound);
      states.push_back({texture.view, sampler(program, use, bound), texture.fill,
                        sampled_.note(bound.image, image, texture.view)});
      sizes.push_back(size_of(stream_, bound));
    }
  }

  /// The texture's own, or the one that the program names with it; any, if it is used without or has several
  /// samples, which are fetched.
  models::SamplerState sampler(const models::Program& program, const models::TextureBinding& use,
                               const traces::TextureDescriptor& bound) {
    if (use.sampler_binding == models::kNoSampler || models::is_multisampled(use.view)) return {};
    traces::Index index = bound.sampler;
    if (use.sampler_binding != models::kCombined) {
      const auto* own = this->bound(&traces::DescriptorSet::samplers, use.sampler_set, use.sampler_binding);
      index = own != nullptr ? own->sampler : traces::kNone;
    }
    if (index == traces::kNone)
      throw user_error("{}: no sampler is bound for the texture at set {}, binding {}", program.name, use.set,
                       models::binding_text(use.binding));
    const models::SamplerState& state = stream_.samplers[index];
    const bool linear = state.mag == models::Filter::kLinear || state.min == models::Filter::kLinear ||
                        state.mip == models::Filter::kLinear;
    if (linear && use.texels != models::NumberKind::kFloat)
      throw user_error("{}: a texture of integers at set {}, binding {} with a linear filter", program.name,
                       use.set, models::binding_text(use.binding));
    return state;
  }

  const traces::TextureDescriptor& texture(const models::Program& program, std::uint32_t set,
                                           std::uint32_t binding) {
    if (const auto* found = bound(&traces::DescriptorSet::textures, set, binding)) return *found;
    throw user_error("{}: no texture is bound at set {}, binding {}", program.name, set,
                     models::binding_text(binding));
  }

  void note_left_out() {
    const auto note = [this](bool unneeded, const char* what, const char* why, std::string saved) {
      if (unneeded) out_.left_out.push_back({what, why, std::move(saved)});
    };
    const auto [images, image_bytes] = resources_.unplaced_images();
    note(images > 0, "textures", "no program of a draw reads them",
         fmt::format("{} textures, {} bytes", images, image_bytes));
    note(unread_attributes_ > 0, "vertex attributes", "the vertex program does not read them",
         fmt::format("{} attributes of draws", unread_attributes_));
  }

  const traces::CommandStream& stream_;
  const ShaderTarget& target_;
  DeviceFrame& out_;
  SampledImages sampled_;
  DeviceResources resources_;
  StorageBinder storage_;
  std::map<std::tuple<Index, Index, bool>, const CompiledPipeline*> programs_;  ///< true: for points
  std::map<std::uint32_t, Index> sets_;
  std::map<std::uint32_t, traces::BindVertexBuffer> vertex_buffers_;
  traces::BindIndexBuffer index_buffer_;
  std::vector<std::byte> push_;
  std::array<models::Viewport, models::kMaxViewports> viewports_;
  std::array<models::PixelRect, models::kMaxViewports> scissors_;
  Index pipeline_ = kNone;
  const traces::BeginPass* begun_ = nullptr;
  AttachmentLives lives_;
  QueryRanges queries_;
  std::uint64_t unread_attributes_ = 0;
};

}  // namespace

bool DeviceFrame::reads_textures() const {
  return std::ranges::any_of(frame.draws, [](const hw::DrawState& d) {
    return !d.vertex.textures.empty() || !d.fragment.textures.empty();
  });
}
bool DeviceFrame::uses_storage() const {
  return std::ranges::any_of(frame.draws, [](const hw::DrawState& d) {
    return !d.vertex.buffers.empty() || !d.fragment.buffers.empty();
  });
}
std::vector<std::string> DeviceFrame::order_dependent() const {
  std::vector<std::string> names;
  for (const CompiledPipeline& pipeline : programs)
    for (const models::Program* program : {&pipeline.vertex, &pipeline.fragment})
      if (program->outputs_follow_atomics && std::ranges::find(names, program->name) == names.end())
        names.push_back(program->name);
  return names;
}
bool DeviceFrame::keeps_depth() const {
  return std::ranges::any_of(frame.passes, [](const hw::PassState& p) { return p.has_depth; });
}
bool DeviceFrame::blends() const {
  return std::ranges::any_of(frame.draws, [](const hw::DrawState& d) {
    std::size_t color = 0;
    while (color < models::kMaxColorAttachments && !d.reads_color(color)) ++color;
    return color < models::kMaxColorAttachments;
  });
}

void build_frame(const traces::CommandStream& stream, const models::Precision& precision, DeviceFrame& out,
                 bool leave_out, const FrameTarget& target) {
  FrameBuilder(stream, precision, target, out).build(leave_out);
}

}  // namespace quadrille::pipeline
