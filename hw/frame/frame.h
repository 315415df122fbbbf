/// What the machine executes: passes and draws with all their state resolved to addresses, programs and
/// constants. Immutable while it runs: texels that come when they are first sampled (`TextureState::fill`)
/// come before anyone can have read them.
///
/// The driver (pipeline/) makes it from a command stream before the machine is elaborated. Tokens name a draw
/// by its index here, so state is versioned by draw and no unit has to be told of a state change.
#pragma once

#include "models/base/attachment.h"
#include "models/base/id.h"
#include "models/geometry/assembly.h"
#include "models/geometry/attribute_format.h"
#include "models/memory/storage.h"
#include "models/memory/surface.h"
#include "models/precision.h"
#include "models/raster/clip.h"
#include "models/raster/primitives.h"
#include "models/raster/triangle_setup.h"
#include "models/raster/viewport.h"
#include "models/rop/blend.h"
#include "models/rop/depth_stencil.h"
#include "models/shader/warp.h"
#include "models/texture/sample.h"
#include "models/texture/texture_fill.h"

#include <bit>
#include <span>
#include <string>
#include <vector>

namespace quadrille::hw {

using models::DrawId;
using models::PartitionId;
using models::PassId;
using models::WarpSlotId;

/// One vertex attribute the vertex program reads: where it comes from and which rows of the warp's inputs it
/// feeds.
struct AttributeFetch {
  std::uint64_t address = 0;  ///< of vertex (or instance) 0
  std::uint32_t stride = 0;   ///< bytes
  models::Format format = models::Format::kR32G32B32Float;
  bool per_instance = false;
  /// row of the warp's inputs for each component; -1: not read
  std::array<int, 4> input_row{-1, -1, -1, -1};
};

struct TextureState {
  models::TextureView view;
  models::SamplerState sampler;
  models::TextureFill* fill = nullptr;  ///< null: the texels lie in device memory
  std::uint32_t texture = 0;            ///< of the images that the frame samples, for figures
  /// Call it between `plan_texture` and `filter_texture`.
  void need_texels(const models::TexturePlan& plan) const {
    if (fill != nullptr && plan.line_count > 0) fill->need();
  }
};

/// The program of a stage with what it is bound to.
struct ProgramState {
  const models::Program* program = nullptr;
  std::vector<std::uint32_t> constants;
  std::vector<TextureState> textures;  ///< by the program's texture index
  std::vector<models::TextureSize> texture_sizes;
  std::vector<models::StorageView> buffers;  ///< by the program's buffer index
};

struct DrawState {
  std::string label;
  PassId pass;
  // Geometry.
  models::Topology topology = models::Topology::kTriangleList;
  bool restarts = false;  ///< a special index ends a strip or fan
  bool indexed = false;
  std::uint32_t index_bytes = 2;
  std::uint64_t index_address = 0;  ///< of the draw's first index
  std::uint32_t count = 0, first_vertex = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t instances = 1, first_instance = 0;
  std::vector<AttributeFetch> attributes;
  /// The driver has found that no primitive of it can reach a pixel (pipeline/driver/draw_culling.h).
  bool outside_view = false;
  // Programs.
  ProgramState vertex, fragment;
  // Fixed function.
  models::PrimitiveState primitives;
  /// by viewport; what set-up's states say of anything but place and depths is the same in all
  std::vector<models::ViewState> views = std::vector<models::ViewState>(1);
  models::DepthStencilState depth_stencil;
  std::array<models::BlendState, models::kMaxColorAttachments> blend;  ///< by colour attachment
  models::BlendShared blend_shared;
  /// Attachment 0 is blended by two colours; the second is where a second attachment's would be.
  bool second_source = false;
  /// Components of the pass's colour attachments that the fragment program writes, as
  /// `models::color_outputs`. Attachments without any keep what they hold; the other components of the rest
  /// are written as 0.
  std::uint32_t color_outputs = 0;
  std::uint32_t integer_colors = 0;  ///< bit i: colour attachment i holds integers
  /// Depth is tested after shading: the program discards, writes depth or memory or takes away samples, and
  /// does not force early tests.
  bool late_depth = false;
  // Several samples a pixel.
  bool by_sample = false;           ///< each covered sample is a fragment of its own, shaded where it lies
  bool reads_coverage = false;      ///< of the fragment program (`models::reads_coverage`)
  bool alpha_to_coverage = false;   ///< alpha of the first colour says which samples stay
  std::uint32_t sample_mask = ~0u;  ///< samples that may be covered, a bit each
  /// Its fragments become nodes, which are put over the colours when the pass ends.
  bool order_independent = false;
  /// The fragment program accesses a buffer that programs of the frame write. Which of its fragments are
  /// shaded must then not depend on the machine: what they read or write could meet another access.
  bool meets_written_memory = false;
  /// An occlusion query is active.
  bool counts_samples = false;

  [[nodiscard]] const ProgramState& stage(models::ShaderStage stage) const {
    return stage == models::ShaderStage::kVertex ? vertex : fragment;
  }
  [[nodiscard]] const models::SetupState& setup() const { return views.front().setup; }
  [[nodiscard]] int varyings() const { return static_cast<int>(vertex.program->varyings.size()); }
  [[nodiscard]] bool smooth_lines() const {
    return setup().line_mode == models::LineMode::kSmooth && primitives.pieces() == models::PieceKind::kLine;
  }
  /// Its fragments have to meet stored depths or stencil values.
  [[nodiscard]] bool uses_depth() const { return depth_stencil.tests(); }
  [[nodiscard]] const models::SampleGrid& samples() const { return setup().samples; }
  [[nodiscard]] bool covers(int sample) const { return (sample_mask >> sample & 1u) != 0; }
  /// What is shaded may have fewer samples than were covered.
  [[nodiscard]] bool limits_coverage() const {
    return alpha_to_coverage || fragment.program->writes_sample_mask;
  }
  /// Hidden fragments are shaded all the same: their program accesses written memory before their depth is
  /// tested. [VK1.3 #fragops-early]
  [[nodiscard]] bool shades_hidden() const { return meets_written_memory && late_depth; }
  /// No fragment may be shaded before it is known to be visible: its program accesses written memory after
  /// the test.
  [[nodiscard]] bool shades_visible_only() const {
    return meets_written_memory && uses_depth() && !late_depth;
  }
  /// An occlusion query counts a sample when it has passed its tests and, unless these are forced to come
  /// before the program, its program: what that takes away then was counted. [VK1.3 #fragops]
  [[nodiscard]] bool counts_before_shading() const { return fragment.program->early_fragment_tests; }
  /// What the early tests write, and what a query counts of them, stays where the program discards the
  /// fragment, or takes its samples, after that: no test may wait for the program. [VK1.3 #fragops-early]
  [[nodiscard]] bool keeps_tests_of_discarded() const {
    const bool counted = counts_samples && counts_before_shading();
    return uses_depth() && !late_depth && (depth_stencil.writes() || counted) &&
           (fragment.program->uses_discard || limits_coverage());
  }
  /// Its tests come before shading on every machine.
  [[nodiscard]] bool must_test_early() const { return shades_visible_only() || keeps_tests_of_discarded(); }
  /// Calls `visit(attachment)` for each colour attachment that the program writes.
  template <class Visit>
  void visit_colors(const Visit& visit) const {
    std::uint32_t left = color_outputs;
    while (left != 0) {
      const auto attachment = static_cast<std::size_t>(std::countr_zero(left)) / 4;
      visit(attachment);
      left &= ~(0xfu << 4 * attachment);
    }
  }
  /// Does a write to this attachment need the old pixel?
  [[nodiscard]] bool reads_color(std::size_t attachment) const {
    return (color_outputs >> 4 * attachment & 0xfu) != 0 &&
           models::reads_destination(blend[attachment], blend_shared);
  }
};

/// An attachment of a pass: where it lies and what happens to it at the pass's begin and end.
struct AttachmentState {
  models::SurfaceLayout surface;
  models::Format format = models::Format::kR8G8B8A8Srgb;
  models::LoadOp load = models::LoadOp::kClear;
  models::StoreOp store = models::StoreOp::kStore;
  models::PixelCode clear{};  ///< encoded: what every pixel begins with, unless it is loaded
  /// Someone reads it after the pass, so tiles that nothing drew to must be written out too.
  bool read_later = true;
  bool encodes = true;  ///< its lines may be stored encoded
  [[nodiscard]] bool loads() const { return load == models::LoadOp::kLoad; }
};

/// What a pass keeps of its order-independent draws. No image: it is gone when the pass ends.
struct TransparencyPass {
  models::Transparency mode = models::Transparency::kNone;  ///< kNone too if it has no such draw
  int layers = 0;                                           ///< nodes that a pixel or sample may have
  /// k-buffer: entries, a plane for each sample and layer of it; A-buffer: heads of lists
  AttachmentState hidden;
  AttachmentState pool;  ///< A-buffer: a block of nodes for each row
  [[nodiscard]] bool on() const { return mode != models::Transparency::kNone; }
  [[nodiscard]] bool lists() const { return mode == models::Transparency::kAbuffer; }
};

struct PassState {
  std::uint32_t width = 0, height = 0;  ///< pixels of each attachment
  std::size_t colors = 0;
  std::array<AttachmentState, models::kMaxColorAttachments> color;
  int samples = 1;  ///< a pixel, of each attachment
  /// Where colour attachments of several samples are resolved to when the pass ends.
  std::array<AttachmentState, models::kMaxColorAttachments> resolve;
  std::uint32_t resolved = 0;  ///< bit i: attachment i is
  AttachmentState depth{{}, models::Format::kD32Float};
  bool has_depth = false;            ///< a draw tests depth, or someone reads it later
  float clear_depth = 1;             ///< of a depth attachment that is not loaded, as it holds it
  bool samples_attachments = false;  ///< that earlier passes drew
  /// What is shown of it.
  [[nodiscard]] const AttachmentState& picture() const {
    return (resolved & 1u) != 0 ? resolve[0] : color[0];
  }
  /// No depth of the pass is known when it begins.
  [[nodiscard]] bool loads_depth() const { return has_depth && depth.loads(); }
  TransparencyPass transparency;
  DrawId first_draw;
  std::uint32_t draws = 0;
};

struct Frame {
  models::StorageMemory* storage = nullptr;  ///< what programs with storage buffers access
  std::vector<PassState> passes;
  std::vector<DrawState> draws;
  models::Precision precision;
  [[nodiscard]] const DrawState& draw(DrawId id) const { return draws[id.index()]; }
  [[nodiscard]] const PassState& pass(PassId id) const { return passes[id.index()]; }
  [[nodiscard]] const PassState& pass_of(DrawId id) const { return pass(draw(id).pass); }
  /// Bytes of a pixel in all colour attachments that the draw's program writes.
  [[nodiscard]] std::uint32_t color_bytes(const DrawState& draw) const {
    std::uint32_t bytes = 0;
    draw.visit_colors([&](std::size_t color) { bytes += pass(draw.pass).color[color].surface.pixel_bytes; });
    return bytes;
  }
  [[nodiscard]] std::span<const DrawState> draws_of(const PassState& pass) const {
    return std::span(draws).subspan(pass.first_draw.index(), pass.draws);
  }
};

}  // namespace quadrille::hw
