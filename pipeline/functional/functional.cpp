#include "pipeline/functional/functional.h"

#include "hw/frame/fragment_output.h"
#include "hw/frame/indices.h"
#include "hw/frame/invocations.h"
#include "hw/frame/transparency.h"
#include "hw/frame/varyings.h"
#include "models/base/error.h"
#include "models/geometry/post_transform.h"
#include "models/geometry/primitive_walk.h"
#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "models/raster/interpolate.h"

#include <bit>

namespace quadrille::pipeline {

namespace {

using hw::BatchSlot;
using hw::DrawState;
using hw::WarpSlot;

/// Runs a warp to its end, filtering its textures as it asks for them.
void run_warp(models::Warp& warp, const std::vector<hw::TextureState>& textures,
              const models::Precision& precision, const models::DeviceMemory& memory,
              models::TexturePlan& plan) {
  std::array<models::LaneFloats, 4> rgba;
  while (models::run_clause(warp).end == models::ClauseEnd::kRequests) {
    for (int i = 0; i < warp.texture_count; ++i) {
      const models::TextureRequest& request = warp.textures[static_cast<std::size_t>(i)];
      const hw::TextureState& texture = textures[request.binding];
      models::plan_texture(texture.view, texture.sampler, request, precision, plan);
      texture.need_texels(plan);
      models::filter_texture(plan, memory, rgba);
      models::write_texture_result(warp, request, rgba);
    }
  }
}

class FunctionalRenderer {
 public:
  FunctionalRenderer(const hw::Frame& frame, models::DeviceMemory& memory, const PieceObserver& observer)
      : frame_(frame), memory_(memory), observer_(observer), triangles_(kTriangles) {}

  FunctionalCounts run() {
    counts_.samples_passed.assign(frame_.draws.size(), 0);
    for (const hw::PassState& pass : frame_.passes) {
      for (std::size_t c = 0; c < pass.colors; ++c) begin(pass.color[c]);
      if (pass.has_depth) begin(pass.depth);
      if (pass.transparency.on()) begin_transparency(pass);
      for (std::uint32_t d = 0; d < pass.draws; ++d) draw(hw::DrawId(pass.first_draw.index() + d));
      if (pass.transparency.on()) compose(pass);
      for (std::size_t c = 0; c < pass.colors; ++c)
        if ((pass.resolved >> c & 1u) != 0) resolve(pass, c);
    }
    return counts_;
  }

 private:
  /// Triangles that waiting quads may refer to, and the one being rasterised.
  static constexpr std::size_t kTriangles = 16;
  using Planes = std::array<std::uint64_t, models::kMaxSamples>;  ///< coverage by sample

  void begin(const hw::AttachmentState& attachment) {
    if (!attachment.loads()) models::fill_surface(memory_, attachment.surface, attachment.clear);
  }

  /// As the only partition.
  void begin_transparency(const hw::PassState& pass) {
    begin(pass.transparency.hidden);
    if (pass.transparency.lists()) pool_ = hw::node_pool_of(pass, models::PartitionId(0), 1);
  }

  void compose(const hw::PassState& pass) {
    const models::SurfaceLayout& surface = pass.transparency.hidden.surface;
    for (std::uint32_t y = 0; y < surface.tiles_y; ++y)
      for (std::uint32_t x = 0; x < surface.tiles_x; ++x) hw::compose_tile(pass, x, y, memory_);
  }

  void resolve(const hw::PassState& pass, std::size_t attachment) {
    const models::SurfaceLayout& surface = pass.color[attachment].surface;
    for (std::uint32_t y = 0; y < surface.tiles_y; ++y)
      for (std::uint32_t x = 0; x < surface.tiles_x; ++x) hw::resolve_tile(pass, attachment, x, y, memory_);
  }

  void draw(hw::DrawId id) {
    draw_ = &frame_.draw(id);
    pass_ = &frame_.pass_of(id);
    warp_.draw = id;
    for (instance_ = 0; instance_ < draw_->instances; ++instance_) {
      walk_.start(draw_->topology, draw_->count, draw_->restarts);
      while (primitive_left()) batch();
    }
    shade();
  }

  bool primitive_left() {
    return walk_.look([&](std::uint32_t p) { return hw::is_restart(*draw_, memory_, p); },
                      [](std::uint32_t) {});
  }

  /// Forms, shades and rasterises the batch that begins with the primitive at which the walk is.
  void batch() {
    const std::unique_ptr<models::VertexReuse> made = models::kBatchReuse.make({});
    models::VertexReuse& reuse = *made;
    batch_.triangles.clear();
    while (primitive_left() && add_primitive(reuse)) walk_.advance();
    batch_.lanes = reuse.size();
    batch_.attributes.resize(draw_->vertex.program->vertex_inputs.size());
    batch_.outputs.resize(static_cast<std::size_t>(models::vertex_outputs(*draw_->vertex.program)));
    fetch(reuse);
    shade_vertices();
    for (const BatchSlot::Triangle& triangle : batch_.triangles) clip(triangle);
  }

  /// Does the primitive at which the walk is fit into the batch?
  bool add_primitive(models::VertexReuse& reuse) {
    const std::size_t corners = draw_->primitives.corners();
    const auto position = walk_.positions();
    std::array<std::uint32_t, 3> vertex{};
    for (std::size_t i = 0; i < corners; ++i) vertex[i] = hw::vertex_number(*draw_, memory_, position[i]);
    if (!reuse.fits(std::span(vertex).first(corners))) return false;
    BatchSlot::Triangle primitive{{}, walk_.primitive()};
    for (std::size_t i = 0; i < 3; ++i)
      primitive.corner[i] = i < corners ? reuse.place(vertex[i]) : primitive.corner[corners - 1];
    batch_.triangles.push_back(primitive);
    return true;
  }

  void fetch(const models::VertexReuse& reuse) {
    for (int lane = 0; lane < batch_.lanes; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      batch_.inputs.vertex_index[l] = reuse.index(lane);
      batch_.inputs.instance_index[l] = draw_->first_instance + instance_;
      for (const hw::AttributeFetch& f : draw_->attributes) {
        const std::uint32_t element = f.per_instance ? draw_->first_instance + instance_ : reuse.index(lane);
        std::uint32_t value[4];
        models::decode_attribute(
            f.format,
            memory_.read(f.address + std::uint64_t{element} * f.stride, models::format_bytes(f.format))
                .data(),
            value);
        for (std::size_t c = 0; c < 4; ++c) {
          if (f.input_row[c] >= 0) batch_.attributes[static_cast<std::size_t>(f.input_row[c])][l] = value[c];
        }
      }
    }
    batch_.inputs.attributes = batch_.attributes.data();
  }

  void shade_vertices() {
    counts_.vertices += static_cast<std::uint64_t>(batch_.lanes);
    engine_.vertex = &batch_.inputs;
    engine_.fragment = nullptr;
    engine_.outputs = batch_.outputs.data();
    hw::bind_storage(frame_, warp_.draw, batch_, storage_, engine_);
    engine_.texture_sizes = draw_->vertex.texture_sizes.data();
    const models::LaneMask lanes =
        batch_.lanes == models::kWarpLanes ? ~models::LaneMask{0} : (models::LaneMask{1} << batch_.lanes) - 1;
    engine_.launch(*draw_->vertex.program, draw_->vertex.constants.data(), lanes);
    run_warp(engine_, draw_->vertex.textures, frame_.precision, memory_, plan_);
  }

  void clip(const BatchSlot::Triangle& triangle) {
    ++counts_.triangles;
    const auto output = [&](std::size_t corner, int slot) {
      return std::bit_cast<float>(
          batch_.outputs[static_cast<std::size_t>(slot)][triangle.corner[corner].lane]);
    };
    models::read_vertices(draw_->primitives, models::first_extra_output(*draw_->vertex.program), output,
                          vertices_);
    models::clip_primitive(vertices_, draw_->primitives, draw_->views, clipped_);
    switch (clipped_.outcome) {
      case models::ClipOutcome::kRejected: ++counts_.fates.off_screen; return;
      case models::ClipOutcome::kNotFinite: ++counts_.fates.not_finite; return;
      case models::ClipOutcome::kCulled: ++counts_.fates.culled; return;
      case models::ClipOutcome::kInside:
      case models::ClipOutcome::kClipped: break;
    }
    for (int i = 0; i < clipped_.count; ++i) piece(triangle, clipped_.pieces[static_cast<std::size_t>(i)]);
  }

  void piece(const BatchSlot::Triangle& triangle, const models::ClippedPiece& piece) {
    // Quads that wait in the warp still need their triangles' slots.
    if (warp_.quads > 0 && sequence_ - warp_.quad[0].triangle >= kTriangles) shade();
    hw::TriangleSlot& slot = triangles_[sequence_];
    switch (models::setup_piece(piece, draw_->primitives, draw_->views[piece.viewport].setup, slot.setup)) {
      case models::SetupOutcome::kCulledFace: ++counts_.fates.culled; return;
      case models::SetupOutcome::kZeroArea: ++counts_.fates.no_area; return;
      case models::SetupOutcome::kOffscreen: ++counts_.fates.off_screen; return;
      case models::SetupOutcome::kNoSample: ++counts_.fates.no_sample; return;
      case models::SetupOutcome::kKept: ++counts_.fates.rasterised; break;
    }
    if (observer_) observer_({warp_.draw, instance_, triangle.primitive, piece});
    if (draw_->smooth_lines()) slot.line = models::piece_coverage(piece, draw_->setup());
    slot.draw = warp_.draw;
    slot.primitive = triangle.primitive;
    slot.instance = draw_->first_instance + instance_;
    std::array<hw::CornerOutputs, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {&batch_.outputs, triangle.corner[k].lane};
    hw::gather_varyings(corners, draw_->varyings(), slot.varyings);
    rasterize(slot.setup);
    ++sequence_;
  }

  void rasterize(const models::TriangleSetup& setup) {
    const models::SampleGrid& samples = draw_->samples();
    models::TileWalk walk(setup, samples);
    models::TileHit tile;
    while (walk.next(tile)) {
      Planes planes{};
      std::uint64_t any = 0;
      for (int s = 0; s < samples.count; ++s) {
        std::uint64_t& coverage = planes[static_cast<std::size_t>(s)];
        if (!draw_->covers(s)) continue;
        coverage = tile.fully_covered ? ~std::uint64_t{0}
                                      : models::sample_coverage(setup, tile.tile_x, tile.tile_y, samples, s);
        counts_.fragments_covered += static_cast<std::uint64_t>(std::popcount(coverage));
        if (draw_->uses_depth() && !draw_->late_depth) coverage = test_tile(setup, tile, s, coverage);
        if (draw_->counts_before_shading())
          count_samples(static_cast<std::uint64_t>(std::popcount(coverage)));
        any |= coverage;
      }
      if (draw_->by_sample) {
        for (std::size_t s = 0; s < planes.size(); ++s) {
          Planes one{};
          one[s] = planes[s];
          add_quads(tile, one, planes[s], static_cast<std::uint8_t>(s));
        }
      } else {
        add_quads(tile, planes, any, 0);
      }
    }
  }

  /// `any`: pixels of which a sample is covered; `sample`: of a draw by sample, the one.
  void add_quads(const models::TileHit& tile, const Planes& planes, std::uint64_t any, std::uint8_t sample) {
    for (std::uint32_t quads = models::quads_of(any); quads != 0; quads &= quads - 1) {
      add_quad(tile, planes, any, std::countr_zero(quads));
      warp_.quad[static_cast<std::size_t>(warp_.quads - 1)].sample = sample;
    }
  }

  void count_samples(std::uint64_t samples) { counts_.samples_passed[warp_.draw.index()] += samples; }

  models::DepthPlane plane(std::uint32_t tile_x, std::uint32_t tile_y, int sample) {
    return hw::depth_plane(pass_->depth, memory_, tile_x, tile_y, static_cast<std::uint32_t>(sample));
  }

  std::uint64_t test_tile(const models::TriangleSetup& setup, const models::TileHit& tile, int sample,
                          std::uint64_t coverage) {
    alignas(32) float incoming[models::kTilePixels];
    models::sample_depths(setup, tile.tile_x, tile.tile_y, draw_->samples(), sample, incoming);
    models::DepthPlane stored =
        plane(static_cast<std::uint32_t>(tile.tile_x), static_cast<std::uint32_t>(tile.tile_y), sample);
    models::round_depths(stored.format(), incoming);
    const models::DepthStencilOutcome outcome =
        models::test_depth_stencil(draw_->depth_stencil, setup.front_facing, stored, incoming, coverage);
    models::write_depth_stencil(outcome, incoming, stored);
    const std::uint64_t survivors = outcome.passed;
    counts_.fates.hidden += static_cast<std::uint64_t>(std::popcount(coverage & ~survivors));
    return survivors;
  }

  void add_quad(const models::TileHit& tile, const Planes& planes, std::uint64_t any, int q) {
    if (warp_.quads == models::kWarpQuads) shade();
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint8_t& samples = warp_.samples[4 * static_cast<std::size_t>(warp_.quads) + i];
      samples = 0;
      for (std::size_t s = 0; s < planes.size(); ++s)
        samples = static_cast<std::uint8_t>(samples |
                                            (planes[s] >> (4 * static_cast<std::size_t>(q) + i) & 1u) << s);
    }
    const auto lanes = static_cast<std::uint32_t>(any >> (4 * q)) & 0xfu;
    warp_.covered |= lanes << (4 * warp_.quads);
    warp_.quad[static_cast<std::size_t>(warp_.quads++)] = {
        sequence_, static_cast<std::uint16_t>(8 * tile.tile_x + 2 * (q & 3)),
        static_cast<std::uint16_t>(8 * tile.tile_y + 2 * (q >> 2))};
  }

  void shade() {
    if (warp_.quads == 0) return;
    const auto live = static_cast<std::uint64_t>(std::popcount(warp_.covered));
    counts_.fragments_shaded += live;
    counts_.helper_lanes += 4 * static_cast<std::uint64_t>(warp_.quads) - live;
    hw::fill_fragment_inputs(*draw_, warp_, triangles_, inputs_);
    const models::LaneMask lanes = warp_.quads == models::kWarpQuads
                                       ? ~models::LaneMask{0}
                                       : (models::LaneMask{1} << (4 * warp_.quads)) - 1;
    engine_.vertex = nullptr;
    engine_.fragment = &inputs_;
    engine_.outputs = outputs_.data();
    hw::bind_storage(frame_, warp_, triangles_, storage_, engine_);
    engine_.texture_sizes = draw_->fragment.texture_sizes.data();
    engine_.launch(*draw_->fragment.program, draw_->fragment.constants.data(), lanes);
    run_warp(engine_, draw_->fragment.textures, frame_.precision, memory_, plan_);
    warp_.alive = warp_.covered & ~engine_.killed;
    hw::take_outputs(*draw_, outputs_, inputs_, warp_);
    counts_.fates.discarded += static_cast<std::uint64_t>(std::popcount(warp_.covered & ~warp_.alive));
    for (int q = 0; q < warp_.quads; ++q) write_quad(q);
    if (draw_->order_independent && pass_->transparency.lists()) {
      const hw::AppendPlan plan = hw::plan_append(*pass_, warp_, memory_);
      hw::append_nodes(*draw_, *pass_, warp_, plan, pool_, memory_);
    }
    warp_.quads = 0;
    warp_.covered = 0;
  }

  void write_quad(int q) {
    const WarpSlot::Quad& quad = warp_.quad[static_cast<std::size_t>(q)];
    hw::QuadOfWarp part{q, models::place_of_quad(quad.x, quad.y), warp_.lanes_of(q)};
    if (part.lanes != 0 && draw_->late_depth) test_late(part);
    counts_.fragments_written += static_cast<std::uint64_t>(std::popcount(part.lanes));
    const int samples = draw_->samples().count;
    for (part.sample = 0; part.sample < samples; ++part.sample) {
      part.lanes = warp_.lanes_of(q, samples, part.sample);
      if (part.lanes == 0) continue;
      if (!draw_->counts_before_shading())
        count_samples(static_cast<std::uint64_t>(std::popcount(part.lanes)));
      if (draw_->order_independent) {
        if (!pass_->transparency.lists()) hw::put_layers(*draw_, *pass_, warp_, part, memory_);
        continue;
      }
      draw_->visit_colors(
          [&](std::size_t attachment) { hw::write_color(*draw_, *pass_, attachment, warp_, part, memory_); });
    }
  }

  void test_late(hw::QuadOfWarp& part) {
    const models::TriangleSetup& triangle =
        triangles_[warp_.quad[static_cast<std::size_t>(part.number)].triangle].setup;
    const hw::QuadOutcome outcome = hw::test_samples(*draw_, warp_, triangle, part, [&](int sample) {
      return plane(part.place.tile_x, part.place.tile_y, sample);
    });
    const models::LaneMask passed = outcome.passed;
    const models::LaneMask killed = part.lanes & ~passed;
    counts_.fates.hidden += static_cast<std::uint64_t>(std::popcount(killed));
    warp_.alive &= ~(killed << (4 * part.number));
    part.lanes = passed;
  }

  const hw::Frame& frame_;
  models::DeviceMemory& memory_;
  const PieceObserver& observer_;
  const DrawState* draw_ = nullptr;
  const hw::PassState* pass_ = nullptr;
  std::uint32_t instance_ = 0;
  FunctionalCounts counts_;
  models::PrimitiveWalk walk_;
  BatchSlot batch_;
  models::PrimitiveVertices vertices_;
  models::ClippedPrimitive clipped_;
  hw::TriangleStore triangles_;
  std::uint64_t sequence_ = 0;
  WarpSlot warp_;
  models::FragmentInputs inputs_;
  std::array<models::LaneWords, models::kFragmentOutputs> outputs_{};
  models::Warp engine_;
  models::WarpStorage storage_;
  models::TexturePlan plan_;
  hw::NodePool pool_;
};

}  // namespace

FunctionalCounts render_functional(const hw::Frame& frame, models::DeviceMemory& memory,
                                   const PieceObserver& observer) {
  return FunctionalRenderer(frame, memory, observer).run();
}

}  // namespace quadrille::pipeline
