/// Walking the commands of a stream: its last render pass, and earlier ones if their attachments are read.
#include "models/reference/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "models/base/error.h"
#include "models/reference/fragments.h"
#include "models/reference/output.h"
#include "models/reference/primitives.h"
#include "models/reference/transparency.h"
#include "traces/attachment_texels.h"

namespace quadrille::models::reference {
namespace {

/// May an attachment be read after the pass that drew it?
bool reads_attachments(const traces::CommandStream& stream) {
  const auto loads = [](const traces::AttachmentUse& use) {
    return use.image != traces::kNone && use.load == traces::LoadOp::kLoad;
  };
  const auto loads_any = [&](const traces::Command& command) {
    const auto* begin = std::get_if<traces::BeginPass>(&command);
    return begin != nullptr && (loads(begin->depth) || std::ranges::any_of(begin->colors, loads));
  };
  const auto sampled = [](const traces::Image& image) {
    return image.is_attachment() && (image.usage & traces::kSampled) != 0;
  };
  return std::ranges::any_of(stream.images, sampled) || std::ranges::any_of(stream.commands, loads_any);
}

/// Keeps the state that commands set, and executes draws of the passes that can be seen.
class Renderer {
 public:
  Renderer(const traces::CommandStream& stream, const Options& options)
      : stream_(stream), options_(options), all_passes_(reads_attachments(stream)) {
    state_.stream = &stream;
    state_.drawn = &drawn_;
    state_.unpacked = &unpacked_;
    // Blocks are decoded by the machine's own code, which tests hold against decoders of others.
    for (traces::Index i = 0; i < stream.images.size(); ++i) {
      const traces::Image& image = stream.images[i];
      if (models::is_block_format(image.format)) unpacked_.emplace(i, traces::decompressed(image));
    }
    for (const traces::Command& command : stream.commands)
      passes_ += std::holds_alternative<traces::BeginPass>(command) ? 1u : 0u;
    traces::for_each_begun_part(stream, [this](const traces::ImagePart& part) { begin_with_texels(part); });
    if (passes_ == 0) throw user_error("command stream '{}': no render pass to draw", stream.name);
    if (options.precision.subpixel_bits < 1 || options.precision.subpixel_bits > 16) {
      throw user_error("reference: subpixel_bits is {}, must be 1..16", options.precision.subpixel_bits);
    }
    const auto earlier = [](const GivenTriangle& a, const GivenTriangle& b) {
      return std::pair(a.draw, a.instance) < std::pair(b.draw, b.instance);
    };
    if (!std::is_sorted(options.given.begin(), options.given.end(), earlier))
      throw user_error("given triangles: not in the order of draws and instances");
  }

  Result render() {
    for (const traces::Command& command : stream_.commands)
      std::visit([this](const auto& c) { execute(c); }, command);
    show();
    if (!options_.given.empty() && options_.given.back().draw >= state_.number) {
      throw user_error("given triangles: draw {} of a stream with {} draws", options_.given.back().draw,
                       state_.number);
    }
    return std::move(result_);
  }

 private:
  /// What earlier frames left, as if a pass had stored it.
  void begin_with_texels(const traces::ImagePart& part) {
    const traces::Image& image = stream_.images[part.image];
    const std::span<const std::byte> texels = traces::part_texels(image, part.level, part.layer);
    const std::size_t bytes = traces::format_bytes(image.format);
    std::vector<PixelCode> codes(texels.size() / bytes);
    for (std::size_t i = 0; i < codes.size(); ++i)
      std::memcpy(codes[i].word.data(), texels.data() + bytes * i, bytes);
    if ((image.usage & traces::kDepthAttachment) != 0) {
      for (PixelCode& code : codes) {
        depths_[part].push_back(load_depth(image.format, code));
        stencils_[part].push_back(load_stencil(image.format, code));
      }
    } else {
      ColorTarget& color = colors_[part];
      color.format = image.format;
      color.code = codes;
      for (const PixelCode& code : codes) {
        const std::array<double, 4> linear = load_color(image.format, code);
        color.linear.insert(color.linear.end(), linear.begin(), linear.end());
      }
    }
    keep(part, codes);
  }

  [[nodiscard]] bool seen() const { return all_passes_ || pass_ == passes_; }

  void execute(const traces::BeginPass& pass) {
    ++pass_;
    if (!seen()) return;
    begun_ = &pass;
    const traces::PassTarget target = traces::target_of(stream_, pass);
    state_.samples = stream_.images[pass.first_image()].samples;
    const std::size_t pixels = std::size_t{target.width} * target.height, values = pixels * state_.samples;
    result_.width = target.width, result_.height = target.height;
    for (std::uint32_t i = 0; i < kMaxViewports; ++i) {
      state_.viewports[i] = {0, 0, static_cast<float>(target.width), static_cast<float>(target.height), 0,
                             1, i};
      state_.scissors[i] = {0, 0, target.width, target.height, i};
    }
    state_.colors.clear();
    for (const traces::ColorAttachmentUse& use : pass.colors) {
      state_.colors.push_back(&colors_[use.part()]);
      if (use.load != traces::LoadOp::kLoad) clear(colors_[use.part()], use, values);
    }
    state_.depth = pass.depth.image == traces::kNone ? nullptr : &depths_[pass.depth.part()];
    if (state_.depth != nullptr && pass.depth.load != traces::LoadOp::kLoad)
      state_.depth->assign(values, held_depth(stream_.images[pass.depth.image].format, clear_depth(pass)));
    note_stencil(pass, values);
    state_.kept = &kept_;
    if (pass.transparency.mode != traces::Transparency::kNone) kept_.resize(values);
    result_.triangle_id.assign(pixels, kNoTriangle);
    result_.depth_margin.assign(pixels, std::numeric_limits<float>::infinity());
    result_.alpha_margin.assign(pixels, std::numeric_limits<float>::infinity());
  }

  /// Stencil values lie beside the depths, cleared and loaded with them.
  void note_stencil(const traces::BeginPass& pass, std::size_t values) {
    state_.stencil = nullptr;
    if (state_.depth == nullptr) return;
    state_.depth_format = stream_.images[pass.depth.image].format;
    state_.stencil = &stencils_[pass.depth.part()];
    if (pass.depth.load == traces::LoadOp::kLoad) return;
    const bool clears = pass.depth.load == traces::LoadOp::kClear;
    state_.stencil->assign(values, clears ? pass.depth.clear_stencil : std::uint8_t{0});
  }

  /// What is not cared about is zero.
  void clear(ColorTarget& color, const traces::ColorAttachmentUse& use, std::size_t pixels) const {
    color.format = stream_.images[use.image].format;
    std::array<double, 4> value{};
    if (use.load == traces::LoadOp::kClear) value = clear_value(color.format, use);
    const StoredColor stored = store_color(color.format, value);
    color.code.assign(pixels, stored.code);
    color.linear.clear();
    for (std::size_t i = 0; i < pixels; ++i)
      color.linear.insert(color.linear.end(), stored.linear.begin(), stored.linear.end());
  }
  static std::array<double, 4> clear_value(traces::Format format, const traces::ColorAttachmentUse& use) {
    std::array<double, 4> value{};
    if (!traces::is_integer_format(format)) std::copy(use.clear.begin(), use.clear.end(), value.begin());
    else
      for (std::size_t c = 0; c < 4; ++c) value[c] = integer_value(format, use.clear_integers[c]);
    return value;
  }
  static double clear_depth(const traces::BeginPass& pass) {
    return pass.depth.load == traces::LoadOp::kClear ? static_cast<double>(pass.depth.clear) : 0.0;
  }

  void execute(const traces::EndPass&) {
    if (!seen()) return;
    if (begun_->transparency.mode != traces::Transparency::kNone) put_over(kept_, *state_.colors[0]);
    for (const traces::ColorAttachmentUse& use : begun_->colors) {
      keep(use.part(), colors_[use.part()].code);
      if (use.resolve == traces::kNone) continue;
      ColorTarget& to = colors_[use.resolve_part()];
      resolve(colors_[use.part()], to);
      keep(use.resolve_part(), to.code);
    }
    if (state_.depth != nullptr && is_sampled(begun_->depth.image)) {
      std::vector<PixelCode> codes;
      codes.reserve(state_.depth->size());
      for (const double z : *state_.depth)
        codes.push_back(store_depth(stream_.images[begun_->depth.image].format, z));
      keep(begun_->depth.part(), codes);
    }
  }

  /// The means of a pixel's samples; of integers the first. [VK1.3 #renderpass-resolve-operations]
  void resolve(const ColorTarget& from, ColorTarget& to) const {
    to.format = from.format;
    to.code.clear();
    to.linear.clear();
    for (std::size_t first = 0; first < from.code.size(); first += state_.samples) {
      std::array<double, 4> mean{};
      const bool integers = traces::is_integer_format(from.format);
      if (integers) mean = load_color(from.format, from.code[first]);
      for (std::uint32_t s = 0; s < state_.samples && !integers; ++s) {
        const std::array<double, 4> color = load_color(from.format, from.code[first + s]);
        for (std::size_t c = 0; c < 4; ++c) mean[c] += color[c] / state_.samples;
      }
      const StoredColor stored = store_color(from.format, mean);
      to.code.push_back(stored.code);
      to.linear.insert(to.linear.end(), stored.linear.begin(), stored.linear.end());
    }
  }

  [[nodiscard]] bool is_sampled(traces::Index image) const {
    return (stream_.images[image].usage & traces::kSampled) != 0;
  }

  /// Makes what a pass drew a level of a texture.
  void keep(const traces::ImagePart& part, const std::vector<PixelCode>& codes) {
    if (!is_sampled(part.image)) return;
    const auto [place, fresh] = drawn_.try_emplace({part.image, part.layer}, stream_.images[part.image]);
    traces::Image& image = place->second;
    if (fresh) image.texels.assign(image.samples * traces::texel_bytes(image) / image.layers, std::byte{0});
    std::byte* at = image.texels.data();
    for (std::uint32_t level = 0; level < part.level; ++level) at += traces::level_bytes(image, level);
    const std::size_t bytes = traces::format_bytes(image.format);
    for (std::size_t i = 0; i < codes.size(); ++i) std::memcpy(at + bytes * i, codes[i].word.data(), bytes);
  }

  /// The last pass's picture.
  void show() {
    const traces::ImagePart resolved = begun_->colors.at(0).resolve_part();
    const ColorTarget& shown = resolved.image == traces::kNone ? *state_.colors[0] : colors_.at(resolved);
    result_.color.clear();
    for (const PixelCode& code : shown.code) result_.color.push_back(to_bytes(shown.format, code));
    result_.color_linear = shown.linear;
    if (state_.depth != nullptr) {
      result_.depth.clear();  // of the first samples
      for (std::size_t i = 0; i < state_.depth->size(); i += state_.samples)
        result_.depth.push_back((*state_.depth)[i]);
    } else result_.depth.assign(shown.code.size(), clear_depth(*begun_));
  }

  void execute(const traces::BindPipeline& c) { state_.pipeline = &stream_.pipelines[c.pipeline]; }
  void execute(const traces::BindDescriptorSet& c) { state_.descriptor_sets[c.set] = c.descriptors; }
  void execute(const traces::BindVertexBuffer& c) { state_.vertex_buffers[c.binding] = {c.buffer, c.offset}; }
  void execute(const traces::BindIndexBuffer& c) { state_.index_buffer = c; }
  void execute(const traces::PushConstants& c) {
    if (c.offset > state_.push_constants.size() || c.data.size() > state_.push_constants.size() - c.offset) {
      throw user_error("push constants: bytes {}..{}, there are {}", c.offset, c.offset + c.data.size(),
                       state_.push_constants.size());
    }
    std::copy(c.data.begin(), c.data.end(),
              state_.push_constants.begin() + static_cast<std::ptrdiff_t>(c.offset));
  }
  void execute(const traces::SetViewport& c) { state_.viewports[c.index] = c; }
  void execute(const traces::BeginQuery&) {}
  void execute(const traces::EndQuery&) {}
  void execute(const traces::SetScissor& c) { state_.scissors[c.index] = c; }

  void execute(const traces::Draw& draw) {
    state_.draw = &draw;
    if (seen()) {
      if (state_.pipeline == nullptr) throw user_error("draw {}: no pipeline is bound", state_.number);
      if (draw.indexed && state_.index_buffer.buffer == traces::kNone)
        throw user_error("draw {}: no index buffer is bound", state_.number);
      draw_instances();
    }
    ++state_.number;
  }

  void draw_instances() {
    FragmentWork work;
    for (std::uint32_t i = 0; i < state_.pipeline->viewports; ++i) work.bounds.push_back(bounds(i));
    const auto none = [](const PixelBounds& b) { return b.first_x > b.last_x || b.first_y > b.last_y; };
    if (std::ranges::all_of(work.bounds, none)) return;
    const Precision* precision = options_.mode == Mode::kGiven ? &options_.precision : nullptr;
    const BoundShader vertex_shader = bind_shader(program(state_.pipeline->vertex_shader), state_, precision);
    BoundShader fragment_shader;
    const bool has_fragment_shader = state_.pipeline->fragment_shader != traces::kNone;
    if (has_fragment_shader)
      fragment_shader = bind_shader(program(state_.pipeline->fragment_shader), state_, precision);
    work.state = &state_, work.vertex_shader = &vertex_shader,
    work.fragment_shader = has_fragment_shader ? &fragment_shader : nullptr;
    work.float_depth = options_.mode == Mode::kGiven, work.threads = options_.threads;
    for (std::uint32_t instance = 0; instance < state_.draw->instances; ++instance) {
      const std::span<const GivenTriangle> given = given_of(instance);
      if (options_.mode == Mode::kGiven && given.empty()) continue;
      const ShadedVertices vertices = shade_vertices(state_, vertex_shader, instance, options_.threads);
      const std::vector<WindowTriangle> triangles =
          options_.mode == Mode::kGiven
              ? take_given(state_, vertices, given, options_.precision.subpixel_bits, work.bounds)
              : clip_and_project(state_, vertices, instance, work.bounds);
      work.vertices = &vertices, work.triangles = triangles;
      draw_fragments(work, result_);
    }
  }

  /// The given triangles of one instance of the current draw; instances follow each other within a draw.
  [[nodiscard]] std::span<const GivenTriangle> given_of(std::uint32_t instance) const {
    const auto key = [](const GivenTriangle& t) { return std::uint64_t{t.draw} << 32 | t.instance; };
    const std::uint64_t wanted = std::uint64_t{state_.number} << 32 | instance;
    const auto first = std::lower_bound(options_.given.begin(), options_.given.end(), wanted,
                                        [&](const GivenTriangle& t, std::uint64_t k) { return key(t) < k; });
    const auto last = std::upper_bound(first, options_.given.end(), wanted,
                                       [&](std::uint64_t k, const GivenTriangle& t) { return k < key(t); });
    return {first, last};
  }

  [[nodiscard]] const ShaderProgram& program(traces::Index shader) {
    const auto found = programs_.find(shader);
    return found != programs_.end()
               ? found->second
               : programs_.emplace(shader, decode_shader(stream_.shaders[shader])).first->second;
  }

  /// Does the draw rasterise points? They are drawn whole if their centre is in the view volume.
  [[nodiscard]] bool draws_points() const {
    using traces::Topology;
    const traces::Pipeline& p = *state_.pipeline;
    const bool triangles = p.topology != Topology::kPointList && p.topology != Topology::kLineList &&
                           p.topology != Topology::kLineStrip;
    return triangles ? p.polygon_mode == traces::PolygonMode::kPoint : p.topology == Topology::kPointList;
  }

  /// To the pixels whose centre is in a viewport: at its sides what is drawn is not cut before.
  static void limit(const traces::SetViewport& v, PixelBounds& b) {
    const auto first = [](double edge) { return static_cast<int>(std::ceil(edge - 0.5)); };
    const double left = v.x, right = left + static_cast<double>(v.width), y0 = v.y,
                 y1 = y0 + static_cast<double>(v.height);
    b.first_x = std::max(b.first_x, first(left)), b.last_x = std::min(b.last_x, first(right) - 1);
    b.first_y = std::max(b.first_y, first(std::min(y0, y1)));
    b.last_y = std::min(b.last_y, first(std::max(y0, y1)) - 1);
  }

  /// Target, scissor, viewport and the region asked for.
  [[nodiscard]] PixelBounds bounds(std::uint32_t viewport) const {
    const traces::SetScissor& s = state_.scissors[viewport];
    const auto clamp = [](std::int64_t a, std::int64_t high) {
      return static_cast<int>(std::clamp<std::int64_t>(a, 0, high));
    };
    const std::int64_t width = result_.width, height = result_.height;
    PixelBounds b{clamp(s.x, width), clamp(s.y, height), clamp(std::int64_t{s.x} + s.width, width) - 1,
                  clamp(std::int64_t{s.y} + s.height, height) - 1};
    if (!draws_points()) limit(state_.viewports[viewport], b);
    if (options_.region && pass_ == passes_) {
      const PixelRect& r = *options_.region;
      b.first_x = std::max(b.first_x, clamp(r.x, width)), b.first_y = std::max(b.first_y, clamp(r.y, height));
      b.last_x = std::min(b.last_x, clamp(std::int64_t{r.x} + r.width, width) - 1);
      b.last_y = std::min(b.last_y, clamp(std::int64_t{r.y} + r.height, height) - 1);
    }
    return b;
  }

  const traces::CommandStream& stream_;
  const Options& options_;
  DrawState state_;
  bool all_passes_ = false;
  std::uint32_t passes_ = 0, pass_ = 0;
  const traces::BeginPass* begun_ = nullptr;
  std::map<traces::ImagePart, ColorTarget> colors_;
  std::map<traces::ImagePart, std::vector<double>> depths_;
  std::map<traces::ImagePart, std::vector<std::uint8_t>> stencils_;
  std::vector<KeptFragments> kept_;
  DrawnLayers drawn_;
  UnpackedImages unpacked_;
  std::map<traces::Index, ShaderProgram> programs_;
  Result result_;
};

}  // namespace

Result render(const traces::CommandStream& stream, const Options& options) {
  return Renderer(stream, options).render();
}

}  // namespace quadrille::models::reference
