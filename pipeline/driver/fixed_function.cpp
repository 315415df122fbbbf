#include "pipeline/driver/fixed_function.h"

#include "models/base/error.h"

#include <cmath>

namespace quadrille::pipeline {
namespace {

models::PrimitiveState primitives(const traces::Pipeline& pipeline, const models::Program& vertex) {
  return {models::assembled_kind(pipeline.topology),
          pipeline.polygon_mode,
          vertex.extras.clip_distances,
          vertex.extras.cull_distances,
          vertex.extras.point_size,
          vertex.extras.viewport_index};
}

/// What depths of a format are apart; 0 for floats, or without an attachment.
double depth_step(models::Format format) {
  const models::FormatInfo& info = models::format_info(format);
  return info.numeric == models::Numeric::kUnorm ? std::ldexp(1.0, -info.component[0].bits) : 0;
}

/// Without an attachment nothing is tested.
models::DepthStencilState depth_stencil(const traces::Pipeline& pipeline, models::Format format) {
  models::DepthStencilState state;
  state.depth_compare = pipeline.depth.compare;
  if (format == models::Format::kUndefined) return state;
  state.depth_test = pipeline.depth.test;
  state.depth_write = pipeline.depth.test && pipeline.depth.write;
  state.bounds = pipeline.depth_bounds;
  if (models::has_stencil(format)) state.stencil = pipeline.stencil;
  return state;
}

/// Integers are written to formats of integers of their sign, and to no others.
void check_color_kinds(const traces::Pipeline& pipeline, const hw::PassState& pass,
                       const hw::DrawState& draw) {
  const models::Program& program = *draw.fragment.program;
  draw.visit_colors([&](std::size_t color) {
    const models::Format format = pass.color[color].format;
    const models::NumberKind wanted = models::number_kind(format), given = program.color_kinds[color];
    if (given != wanted)
      throw user_error("{}: writes {} to location {}, where pipeline '{}' draws to {}, which holds {}",
                       program.name, models::name_of(given), color, pipeline.name,
                       models::format_info(format).name, models::name_of(wanted));
  });
}

void check_programs(const traces::Pipeline& pipeline, const hw::PassState& pass, const hw::DrawState& draw) {
  const models::Program& program = *draw.fragment.program;
  if (draw.second_source && (!program.second_source || pass.colors != 1))
    throw user_error(
        "{}: pipeline '{}' blends by a second colour: the fragment shader has to have an output at location "
        "0, index 1, and the pass one colour attachment",
        program.name, pipeline.name);
  check_color_kinds(pipeline, pass, draw);
  if (models::writes_buffers(program) && draw.primitives.pieces() != draw.primitives.assembled)
    throw user_error(
        "{}: writes memory where pipeline '{}' draws triangles by their edges or corners, which is not "
        "supported: two edges of a triangle may cover one pixel; draw lines or points",
        program.name, pipeline.name);
}

models::ViewState view(const FixedFunctionInputs& in, const models::Viewport& viewport,
                       const models::PixelRect& scissor, bool points) {
  const traces::Pipeline& pipeline = in.pipeline;
  const models::PixelRect rect = models::drawable_rect(viewport, scissor, in.pass.width, in.pass.height);
  return {
      viewport,
      models::make_clip_state(viewport, pipeline.depth_clamp, in.subpixel_bits),
      // A point whose centre is in the view volume is drawn whole.
      {pipeline.cull, pipeline.front, points ? scissor : rect, in.subpixel_bits, viewport.min_depth,
       viewport.max_depth, pipeline.line_mode, pipeline.line_width,
       models::sample_grid(in.pass.samples, in.subpixel_bits), pipeline.depth_bias, depth_step(in.depth)}};
}

void set_raster(const FixedFunctionInputs& in, hw::DrawState& draw) {
  draw.primitives = primitives(in.pipeline, *draw.vertex.program);
  const bool points = draw.primitives.pieces() == models::PieceKind::kPoint;
  draw.views.clear();
  // A program that does not choose one draws to the first.
  const std::uint32_t views = draw.primitives.viewport_index ? in.pipeline.viewports : 1;
  for (std::uint32_t i = 0; i < views; ++i)
    draw.views.push_back(view(in, in.viewports[i], in.scissors[i], points));
}

/// Components of the pass's attachments that the program writes; a second colour goes to none.
std::uint32_t color_outputs(const models::Program& program, std::size_t colors) {
  const std::uint32_t attached = colors < models::kMaxColorAttachments ? (1u << 4 * colors) - 1 : ~0u;
  const std::uint32_t second = program.second_source ? 0xfu << models::kSecondSourceOutput : 0;
  return models::color_outputs(program) & attached & ~second;
}

}  // namespace

void set_fixed_function(const FixedFunctionInputs& in, hw::DrawState& draw) {
  const traces::Pipeline& pipeline = in.pipeline;
  const models::Program& program = *draw.fragment.program;
  set_raster(in, draw);
  draw.depth_stencil = depth_stencil(pipeline, in.depth);
  draw.blend = pipeline.blend;
  draw.blend_shared = pipeline.blend_shared;
  draw.second_source = pipeline.blend[0].uses_second_source();
  draw.color_outputs = color_outputs(program, in.pass.colors);
  for (std::size_t i = 0; i < in.pass.colors; ++i)
    if (models::is_integer_format(in.pass.color[i].format)) draw.integer_colors |= 1u << i;
  check_programs(pipeline, in.pass, draw);
  draw.by_sample = draw.samples().count > 1 && (program.by_sample || pipeline.sample_shading);
  draw.reads_coverage = models::reads_coverage(program);
  // Without an alpha there is nothing that could take samples away.
  draw.alpha_to_coverage = pipeline.alpha_to_coverage && (models::color_outputs(program) >> 3 & 1u) != 0;
  draw.sample_mask = pipeline.sample_mask;
  draw.order_independent = pipeline.order_independent && draw.color_outputs != 0;
  draw.late_depth = draw.uses_depth() && !program.early_fragment_tests &&
                    (program.uses_discard || program.writes_depth || models::writes_buffers(program) ||
                     draw.limits_coverage());
}

}  // namespace quadrille::pipeline
