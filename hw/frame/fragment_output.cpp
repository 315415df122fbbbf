#include "hw/frame/fragment_output.h"

#include "models/raster/interpolate.h"
#include "models/rop/alpha_coverage.h"
#include "models/rop/depth.h"
#include "models/rop/resolve.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {
namespace {

/// Samples that the program's outputs leave to a lane.
std::uint32_t kept_samples(const DrawState& draw, std::span<const models::LaneWords> outputs,
                           std::size_t lane) {
  std::uint32_t kept = ~0u;
  if (draw.fragment.program->writes_sample_mask) kept &= outputs[models::kSampleMaskOutput][lane];
  if (draw.alpha_to_coverage && (models::color_outputs(*draw.fragment.program) >> 3 & 1u) != 0)
    kept &= models::alpha_coverage(std::bit_cast<float>(outputs[3][lane]), draw.samples().count);
  return kept;
}

void limit_coverage(const DrawState& draw, std::span<const models::LaneWords> outputs, WarpSlot& warp) {
  for (models::LaneMask lanes = warp.alive; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    std::uint32_t left = kept_samples(draw, outputs, lane) & draw.samples().all();
    if (draw.samples().count > 1) {
      left &= warp.samples[lane];
      warp.samples[lane] = static_cast<std::uint8_t>(left);
    }
    if (left == 0) warp.alive &= ~(1u << lane);
  }
}

}  // namespace

void take_outputs(const DrawState& draw, std::span<const models::LaneWords> outputs,
                  const models::FragmentInputs& inputs, WarpSlot& warp) {
  warp.depth = draw.fragment.program->writes_depth
                   ? std::bit_cast<models::LaneFloats>(outputs[models::kDepthOutput])
                   : inputs.z;
  draw.visit_colors([&](std::size_t attachment) {
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t slot = 4 * attachment + c;
      if ((draw.color_outputs >> slot & 1u) != 0)
        warp.color[attachment][c] = std::bit_cast<models::LaneFloats>(outputs[slot]);
      else warp.color[attachment][c].fill(0);
    }
    if (!draw.smooth_lines()) return;
    models::LaneFloats& alpha = warp.color[attachment][3];
    for (std::size_t lane = 0; lane < alpha.size(); ++lane) alpha[lane] *= inputs.line_coverage[lane];
  });
  if (draw.limits_coverage()) limit_coverage(draw, outputs, warp);
}

models::LaneMask test_depth(const DrawState& draw, const WarpSlot& warp,
                            const models::TriangleSetup& triangle, const QuadOfWarp& quad,
                            float* tile_depths) {
  alignas(32) float incoming[models::kTilePixels] = {};
  const int first = quad.place.first_pixel();
  if (draw.samples().count == 1 || draw.fragment.program->writes_depth)
    std::copy_n(warp.depth.begin() + 4 * quad.number, 4, incoming + first);
  else
    models::sample_depths(triangle, static_cast<int>(quad.place.tile_x), static_cast<int>(quad.place.tile_y),
                          draw.samples(), quad.sample, incoming);
  const std::uint64_t passed =
      models::depth_test(draw.depth_compare, tile_depths, incoming, std::uint64_t{quad.lanes} << first);
  if (draw.depth_write) models::depth_write(tile_depths, incoming, passed);
  return static_cast<models::LaneMask>(passed >> first) & 0xf;
}

void write_color(const DrawState& draw, const PassState& pass, std::size_t attachment, const WarpSlot& warp,
                 const QuadOfWarp& quad, models::DeviceMemory& memory) {
  float rgba[4][4];
  for (std::size_t c = 0; c < 4; ++c)
    std::copy_n(warp.color[attachment][c].begin() + 4 * quad.number, 4, rgba[c]);
  const AttachmentState& target = pass.color[attachment];
  const std::uint64_t address = target.surface.tile_address(quad.place.tile_x, quad.place.tile_y,
                                                            static_cast<std::uint32_t>(quad.sample));
  auto* const tile = reinterpret_cast<std::uint32_t*>(memory.write(address, models::kTileBytes).data());
  models::blend_quad(draw.blend[attachment], target.format, rgba, tile + quad.place.first_pixel(),
                     quad.lanes);
}

void resolve_tile(const PassState& pass, std::size_t attachment, std::uint32_t tile_x, std::uint32_t tile_y,
                  models::DeviceMemory& memory) {
  const models::SurfaceLayout &from = pass.color[attachment].surface, &to = pass.resolve[attachment].surface;
  const std::size_t bytes = std::size_t{models::kTileBytes} * from.samples;
  const auto* const planes =
      reinterpret_cast<const std::uint32_t*>(memory.read(from.tile_address(tile_x, tile_y), bytes).data());
  auto* const pixels = reinterpret_cast<std::uint32_t*>(
      memory.write(to.tile_address(tile_x, tile_y), models::kTileBytes).data());
  models::resolve_tile(pass.color[attachment].format, std::span(planes, bytes / sizeof(std::uint32_t)),
                       pixels);
}

}  // namespace quadrille::hw
