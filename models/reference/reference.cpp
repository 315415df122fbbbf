/// Walking the commands of a stream's last render pass.
#include "models/reference/reference.h"

#include <algorithm>
#include <limits>
#include <map>

#include "models/base/error.h"
#include "models/reference/fragments.h"
#include "models/reference/output.h"
#include "models/reference/primitives.h"

namespace quadrille::models::reference {
namespace {

/// Keeps the state that commands set, and executes draws of the last pass. Earlier passes cannot be seen:
/// attachments are cleared on load and never read.
class Renderer {
 public:
  Renderer(const traces::CommandStream& stream, const Options& options) : stream_(stream), options_(options) {
    state_.stream = &stream;
    for (const traces::Command& command : stream.commands)
      passes_ += std::holds_alternative<traces::BeginPass>(command) ? 1u : 0u;
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
    if (!options_.given.empty() && options_.given.back().draw >= state_.number) {
      throw user_error("given triangles: draw {} of a stream with {} draws", options_.given.back().draw,
                       state_.number);
    }
    return std::move(result_);
  }

 private:
  void execute(const traces::BeginPass& pass) {
    ++pass_;
    if (pass_ != passes_) return;
    state_.target = &stream_.targets[pass.target];
    const std::size_t pixels = std::size_t{state_.target->width} * state_.target->height;
    result_.width = state_.target->width, result_.height = state_.target->height;
    const StoredColor clear = store_color(state_.target->color, {pass.clear_color[0], pass.clear_color[1],
                                                                 pass.clear_color[2], pass.clear_color[3]});
    result_.color.assign(pixels, clear.rgba);
    for (std::size_t i = 0; i < pixels; ++i)
      result_.color_linear.insert(result_.color_linear.end(), clear.linear.begin(), clear.linear.end());
    result_.depth.assign(pixels, static_cast<double>(pass.clear_depth));
    result_.triangle_id.assign(pixels, kNoTriangle);
    result_.depth_margin.assign(pixels, std::numeric_limits<float>::infinity());
    result_.alpha_margin.assign(pixels, std::numeric_limits<float>::infinity());
  }
  void execute(const traces::EndPass&) {}
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
  void execute(const traces::SetViewport& c) { state_.viewport = c, has_viewport_ = true; }
  void execute(const traces::SetScissor& c) { state_.scissor = c, has_scissor_ = true; }

  void execute(const traces::Draw& draw) {
    state_.draw = &draw;
    if (pass_ == passes_) {
      if (state_.pipeline == nullptr) throw user_error("draw {}: no pipeline is bound", state_.number);
      if (!has_viewport_ || !has_scissor_)
        throw user_error("draw {}: no viewport or scissor is set", state_.number);
      if (draw.indexed && state_.index_buffer.buffer == traces::kNone)
        throw user_error("draw {}: no index buffer is bound", state_.number);
      draw_instances();
    }
    ++state_.number;
  }

  void draw_instances() {
    FragmentWork work;
    work.bounds = bounds();
    if (work.bounds.first_x > work.bounds.last_x || work.bounds.first_y > work.bounds.last_y) return;
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

  /// Target, scissor and the region asked for.
  [[nodiscard]] PixelBounds bounds() const {
    const auto clamp = [](std::int64_t a, std::int64_t high) {
      return static_cast<int>(std::clamp<std::int64_t>(a, 0, high));
    };
    const traces::SetScissor& s = state_.scissor;
    const std::int64_t width = result_.width, height = result_.height;
    PixelBounds b{clamp(s.x, width), clamp(s.y, height), clamp(std::int64_t{s.x} + s.width, width) - 1,
                  clamp(std::int64_t{s.y} + s.height, height) - 1};
    if (options_.region) {
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
  bool has_viewport_ = false, has_scissor_ = false;
  std::uint32_t passes_ = 0, pass_ = 0;
  std::map<traces::Index, ShaderProgram> programs_;
  Result result_;
};

}  // namespace

Result render(const traces::CommandStream& stream, const Options& options) {
  return Renderer(stream, options).render();
}

}  // namespace quadrille::models::reference
