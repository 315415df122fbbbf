#include "hw/frame/fragment_output.h"

#include "models/raster/interpolate.h"
#include "models/rop/alpha_coverage.h"
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
  if (draw.alpha_to_coverage)
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
    if (!draw.smooth_lines() || (draw.integer_colors >> attachment & 1u) != 0) return;
    models::LaneFloats& alpha = warp.color[attachment][3];
    for (std::size_t lane = 0; lane < alpha.size(); ++lane) alpha[lane] *= inputs.line_coverage[lane];
  });
  if (draw.second_source) {
    for (std::size_t c = 0; c < 4; ++c)
      warp.color[1][c] = std::bit_cast<models::LaneFloats>(outputs[models::kSecondSourceOutput + c]);
  }
  if (draw.limits_coverage()) limit_coverage(draw, outputs, warp);
}

QuadOutcome test_depth(const DrawState& draw, const WarpSlot& warp, const models::TriangleSetup& triangle,
                       const QuadOfWarp& quad, models::DepthPlane stored) {
  alignas(32) float incoming[models::kTilePixels] = {};
  const int first = quad.place.first_pixel();
  if (draw.samples().count == 1 || draw.fragment.program->writes_depth)
    std::copy_n(warp.depth.begin() + 4 * quad.number, 4, incoming + first);
  else
    models::sample_depths(triangle, static_cast<int>(quad.place.tile_x), static_cast<int>(quad.place.tile_y),
                          draw.samples(), quad.sample, incoming);
  models::round_depths(stored.format(), incoming);
  const models::DepthStencilOutcome outcome = models::test_depth_stencil(
      draw.depth_stencil, triangle.front_facing, stored, incoming, std::uint64_t{quad.lanes} << first);
  models::write_depth_stencil(outcome, incoming, stored);
  return {static_cast<models::LaneMask>(outcome.passed >> first) & 0xf,
          std::popcount(outcome.stencil_written)};
}

models::DepthPlane depth_plane(const AttachmentState& depth, models::DeviceMemory& memory,
                               std::uint32_t tile_x, std::uint32_t tile_y, std::uint32_t sample) {
  const std::uint64_t address = depth.surface.tile_address(tile_x, tile_y, sample);
  return {depth.format, memory.write(address, depth.surface.plane_bytes()).data()};
}

void write_color(const DrawState& draw, const PassState& pass, std::size_t attachment, const WarpSlot& warp,
                 const QuadOfWarp& quad, models::DeviceMemory& memory) {
  const auto gather = [&](std::size_t output, float(&rgba)[4][4]) {
    for (std::size_t c = 0; c < 4; ++c)
      std::copy_n(warp.color[output][c].begin() + 4 * quad.number, 4, rgba[c]);
  };
  float rgba[4][4], second[4][4];
  gather(attachment, rgba);
  if (draw.second_source) gather(1, second);
  const AttachmentState& target = pass.color[attachment];
  const std::uint64_t address = target.surface.tile_address(quad.place.tile_x, quad.place.tile_y,
                                                            static_cast<std::uint32_t>(quad.sample));
  std::byte* const tile = memory.write(address, target.surface.plane_bytes()).data();
  const std::size_t first = static_cast<std::size_t>(quad.place.first_pixel()) * target.surface.pixel_bytes;
  models::blend_quad(draw.blend[attachment], draw.blend_shared, target.format, rgba,
                     draw.second_source ? second : nullptr, tile + first, quad.lanes);
}

void resolve_tile(const PassState& pass, std::size_t attachment, std::uint32_t tile_x, std::uint32_t tile_y,
                  models::DeviceMemory& memory) {
  const models::SurfaceLayout &from = pass.color[attachment].surface, &to = pass.resolve[attachment].surface;
  const std::byte* const planes =
      memory.read(from.tile_address(tile_x, tile_y), std::size_t{from.plane_stride()} * from.samples).data();
  std::byte* const pixels = memory.write(to.tile_address(tile_x, tile_y), to.plane_bytes()).data();
  models::resolve_tile(pass.color[attachment].format, planes, from.plane_stride(), from.samples, pixels);
}

}  // namespace quadrille::hw
