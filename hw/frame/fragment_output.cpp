#include "hw/frame/fragment_output.h"

#include "models/raster/interpolate.h"
#include "models/rop/depth.h"
#include "models/rop/resolve.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

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
  std::byte* const tile = memory.write(address, target.surface.plane_bytes()).data();
  const std::size_t first = static_cast<std::size_t>(quad.place.first_pixel()) * target.surface.pixel_bytes;
  models::blend_quad(draw.blend[attachment], target.format, rgba, tile + first, quad.lanes);
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
