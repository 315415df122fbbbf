#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_source.h"

#include <algorithm>
#include <array>

namespace quadrille::pipeline::test {

namespace {

void randomize_link(LinkParams& link, RandomSource& random, bool depth_one) {
  link.depth.set(depth_one ? 1 : random.pick({1, 1, 2, 3, 5, 17}));
  link.width.set(random.integer(1, 2));
  link.credit_latency.set(random.pick({1, 2, 9}));
  link.latency.set(random.chance(0.95) ? random.pick({1, 1, 2, 7, 30}) : random.chance(0.15) ? 100000 : 300);
}

}  // namespace

void randomize(MachineConfig& config, std::uint64_t seed) {
  RandomSource random(seed);
  config.gpu.cores.set(random.integer(1, 8));
  config.gpu.partitions.set(random.integer(1, 8));
  config.gpu.channels.set(random.integer(1, 8));
  const double clocks[] = {1000, 777.777, 31.4159, 3000};
  config.gpu.memory_mhz.set(clocks[random.integer(0, 3)]);
  const bool depth_one = random.chance(0.3);
  for (const auto& [path, group] : config.groups()) {
    if (path.starts_with("link.")) randomize_link(static_cast<LinkParams&>(*group), random, depth_one);
    hw::ParamBase* const ways = group->find("cache_ways");
    if (ways == nullptr) continue;
    const int w = random.pick({1, 1, 2, 4});
    ways->parse(std::to_string(w));
    group->find("cache_lines")->parse(std::to_string(w * random.pick({1, 1, 2, 8, 64})));
    group->find("cache_misses")->parse(std::to_string(random.pick({1, 2, 8})));
  }
  config.work_distributor.policy.set(
      *hw::distribution_policies().all()[static_cast<std::size_t>(random.integer(0, 2))]);
  config.work_distributor.block_tiles.set(random.pick({1, 2, 4, 2048}));
  config.core.warp_slots.set(random.pick({2, 3, 8, 32}));
  config.core.register_rows.set(random.pick({256, 1024}));
  config.core.simds.set(random.pick({1, 2, 4}));
  config.vertex_fetch.batch_slots.set(random.pick({2, 3, 16}));
  // Named by the seed alone, so that the machines of before stay what they were.
  config.coarse_raster.order.set(*models::tile_order_policies().all()[seed % 3]);
  if (seed % 3 == 0 && seed % 2 == 0) config.coarse_raster.traversal.set(hw::kEdgeWalking);
  config.coarse_raster.rows_per_clk.set(1 + static_cast<int>(seed / 6 % 5));
  config.coarse_raster.segments_per_clk.set(1 + static_cast<int>(seed / 6 % 3));
  config.coarse_raster.walk_setup_clk.set(1 + static_cast<int>(seed / 6 % 4));
  config.texture.replacement.set(*models::replacement_policies().all()[seed % 5]);
  config.l2.replacement.set(*models::replacement_policies().all()[seed / 5 % 5]);
  config.depth.compression.set(static_cast<hw::DepthCompression>(seed % 3));
  config.texture.layout.set(static_cast<models::Tiling>(seed / 2 % 4));
  config.texture.tag_banks.set(std::array{1, 2, 4, 16}[seed / 3 % 4]);
  config.texture.fetched_sectors.set(static_cast<hw::FetchedSectors>(seed / 4 % 3));
  config.texture.blocks_held.set(static_cast<hw::BlocksHeld>(seed / 3 % 2));
  config.gpu.anisotropic_footprint.set(static_cast<models::AnisotropicFootprint>(seed / 2 % 3));
  config.texture.decode_blocks_per_clk.set(1 + static_cast<int>(seed % 8));
  config.rop.compression.set(static_cast<hw::ColorCompression>(seed / 2 % 3));
  config.vertex_fetch.reuse.set(
      *models::vertex_reuse_policies().all()[static_cast<std::size_t>(random.integer(0, 2))]);
  config.primitive_assembly.triangles_per_clk.set(random.pick({1, 2, 64}));
  config.clipper.triangles_per_clk.set(random.pick({1, 3, 64}));
  config.triangle_setup.drawn_per_clk.set(random.pick({1, 2, 4}) / 2.0);
  config.triangle_setup.culled_per_clk.set(random.pick({1, 2, 5}) / 3.0);
  config.coarse_raster.tiles_per_clk.set(random.pick({1, 2, 64}));
  config.coarse_raster.reports.set(random.pick({1, 8, 1000}));
  config.fine_raster.tiles_per_clk.set(random.pick({1, 2, 64}));
  config.warp_packer.launch_clk.set(random.pick({0, 1, 7}));
  config.vertex_fetch.batch_vertices.set(random.pick({3, 4, 31, 32}));
  config.vertex_fetch.batch_triangles.set(random.pick({1, 2, 32, 128}));
  config.vertex_fetch.reuse_entries.set(random.pick({3, 4, 16, 128}));
  config.warp_packer.warp_slots.set(random.pick({1, 2, 16}));
  config.warp_packer.patience_clk.set(random.pick({1, 5, 1000}));
  config.triangle_setup.triangle_slots.set(random.pick({1, 2, 9, 64}));
  config.command_processor.draws_in_flight.set(random.pick({1, 2, 32}));
  config.command_processor.cull_draws.set(random.chance(0.5));
  config.depth.tiles_in_flight.set(random.pick({1, 4}));
  config.core.export_bytes_per_clk.set(random.pick({1, 24, 128, 65536}));
  config.rop.half_blend_turns.set(random.pick({1, 5}));
  config.rop.float_blend_turns.set(random.pick({1, 3}));
  config.rop.warps_in_flight.set(random.pick({1, 4}));
  config.texture.groups_in_flight.set(random.pick({1, 4}));
  config.scan_out.lines_in_flight.set(random.pick({1, 50}));
  config.memory.queue_depth.set(random.pick({1, 8}));
  config.coarse_raster.hiz.set(random.chance(0.7));
  config.coarse_raster.hiz_min.set(random.chance(0.5));
  config.gpu.front_ends.set(random.pick({1, 1, 2, 3, 4}));
  config.vertex_fetch.range_primitives.set(random.pick({1, 2, 31, 32, 256}));
  const int engines = random.pick({1, 2, 3, 4});
  config.gpu.engines.set(config.gpu.partitions % engines == 0 ? engines : 1);
}

}  // namespace quadrille::pipeline::test
