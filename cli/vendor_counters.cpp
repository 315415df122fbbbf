#include "cli/vendor_counters.h"

#include <fmt/format.h>

namespace quadrille::cli {
namespace {

// clang-format off: a counter a line
std::vector<VendorCounter> arm() {
  return {
      {"MaliGPUActiveCy", "frame.cycles", "Ours ends with scan-out"},
      {"MaliGPUPix", "frame.width * frame.height",
       "Theirs counts whole tiles of 16x16 or 32x32 pixels, of every pass"},
      {"MaliGPUCyPerPix", "frame.cycles / (frame.width * frame.height)", "As MaliGPUPix"},
      {"MaliGeomTotalPrim", "primitive_assembly.triangles", ""},
      {"MaliGeomFaceCullPrim", "triangle_setup.culled + clipper.culled",
       "Theirs also counts triangles without area"},
      {"MaliGeomPlaneCullPrim", "clipper.rejected", ""},
      {"MaliGeomScissorCullPrim", "triangle_setup.offscreen", ""},
      {"MaliGeomSampleCullPrim", "triangle_setup.no_sample", ""},
      {"MaliGeomVisiblePrim", "triangle_setup.kept",
       "Pieces of cut triangles count each; theirs are cut without being counted"},
      {"MaliNonFragWarp", "core.vertex_warps",
       "Warps have 32 lanes here, 4 to 16 there; nothing but vertices is shaded"},
      {"MaliNonFragThread", "core.vertices", "Live lanes; theirs are all lanes of the warps"},
      {"MaliFragWarp", "core.fragment_warps", "Warps have 32 lanes here, 4 to 16 there"},
      {"MaliFragPartWarp", "warp_packer.partial_warps",
       "Here a warp of fewer than 8 quads; there one with a lane without coverage"},
      {"MaliFragPartWarpRate", "warp_packer.partial_warps / warp_packer.warps", "As MaliFragPartWarp"},
      {"MaliFragThread", "core.fragments + core.helper_lanes", "Theirs are all lanes of the warps"},
      {"MaliFragRastPrim", "coarse_raster.triangles",
       "Theirs counts a primitive once a tile that it touches"},
      {"MaliFragRastQd", "fine_raster.quads", ""},
      {"MaliFragShadedQd", "warp_packer.quads", ""},
      {"MaliFragEZSTestQd", "depth.early_tested", "Samples, not quads"},
      {"MaliFragEZSKillQd", "depth.early_killed", "Samples, not quads"},
      {"MaliFragLZSTestQd", "depth.late_tested", "Samples, not quads"},
      {"MaliFragLZSKillQd", "depth.late_killed", "Pixels, not quads"},
      {"MaliEngInstr", "core.instructions", "Instructions of another instruction set, counted a warp"},
      {"MaliTexFiltIssueCy", "texture.bilinear_quads",
       "Theirs are cycles; a unit here filters `texture.filter_quads_per_clk` of them a cycle"},
      {"MaliTexCacheLookupCy", "texture.cache_requests",
       "Theirs are cycles; a unit here looks up `texture.tags_per_clk` a cycle"},
      {"MaliL2CacheLookup", "l2.requests", "Reads and writes together"},
      {"MaliExtBusRd", "memory.reads", "Requests of a line here, transactions of a bus there"},
      {"MaliExtBusWr", "memory.writes", "As MaliExtBusRd"},
      {"MaliExtBusRdBy", "memory.read_bytes", ""},
      {"MaliExtBusWrBy", "memory.write_bytes", ""},
  };
}

std::vector<VendorCounter> rgp() {
  return {
      {"GPUBusyCycles", "frame.cycles", "Ours ends with scan-out"},
      {"VsGsVerticesIn", "core.vertices",
       "Vertices that are shaded again because a batch forgot them count again, there too"},
      {"VsGsPrimsIn", "primitive_assembly.triangles", "There are no geometry shaders here"},
      {"PrimitivesIn", "clipper.triangles", ""},
      {"CulledPrims",
       "clipper.rejected + clipper.culled + triangle_setup.culled + triangle_setup.zero_area + "
       "triangle_setup.offscreen + triangle_setup.no_sample",
       ""},
      {"ClippedPrims", "clipper.clipped", "Here only beyond the guard band, at the sides (D9)"},
      {"PSPixelsOut", "rop.pixels_written", "Theirs counts a pixel once a colour target, before blending"},
      {"HiZTilesRejectedCount", "coarse_raster.tiles_hidden", ""},
      {"HiZTilesAcceptedCount", "coarse_raster.tiles_kept", ""},
      {"HiZTilesAccepted",
       "coarse_raster.tiles_kept / (coarse_raster.tiles_kept + coarse_raster.tiles_hidden)", ""},
      {"PreZTilesDetailCulledCount", "fine_raster.tiles_empty", ""},
      {"PreZTilesDetailSurvivingCount", "fine_raster.tiles - fine_raster.tiles_empty", ""},
      {"PreZSamplesPassing", "depth.early_tested - depth.early_killed", ""},
      {"PreZSamplesFailingZ", "depth.early_killed",
       "Depth and stencil together; theirs has PreZSamplesFailingS beside it"},
      {"PostZSamplesPassing", "depth.late_tested - depth.late_killed_samples", ""},
      {"PostZSamplesFailingZ", "depth.late_killed_samples", "Depth and stencil together"},
      {"PostZQuadCount", "warp_packer.quads", ""},
      {"DBMemRead", "depth.read_bytes", "Of the L2 cache here, of memory there"},
      {"DBMemWritten", "depth.write_bytes", "As DBMemRead"},
      {"L0CacheRequestCount", "texture.cache_requests + load_store.cache_requests",
       "Requests are lines here, 128 bytes there"},
      {"L0CacheHitCount", "texture.cache_hits + load_store.cache_hits",
       "Merged look-ups are neither hits nor misses here"},
      {"L0CacheMissCount", "texture.cache_misses + load_store.cache_misses", "As L0CacheHitCount"},
      {"L2CacheRequestCount", "l2.requests", "Requests have up to a line here, 128 bytes there"},
      {"L2CacheHitCount", "l2.hits", "Merged look-ups are neither hits nor misses here"},
      {"L2CacheMissCount", "l2.misses", "As L2CacheHitCount"},
      {"L2CacheHit", "l2.hits / l2.requests", "As L2CacheHitCount"},
      {"FetchSize", "memory.read_bytes", ""},
      {"WriteSize", "memory.write_bytes", ""},
      {"LocalVidMemBytes", "memory.read_bytes + memory.write_bytes",
       "There is no last-level cache before memory here"},
  };
}

std::vector<VendorCounter> nsight() {
  return {
      {"gpc__cycles_elapsed", "frame.cycles", "Ours ends with scan-out"},
      {"pda__input_prims", "vertex_fetch.triangles", ""},
      {"raster__zcull_input_samples", "coarse_raster.tiles_kept + coarse_raster.tiles_hidden",
       "Tiles of 8x8 pixels that Hi-Z saw, not samples"},
      {"raster__zcull_input_samples_op_accepted", "coarse_raster.tiles_kept", "Tiles, not samples"},
      {"raster__zcull_input_samples_op_rejected", "coarse_raster.tiles_hidden", "Tiles, not samples"},
      {"prop__input_pixels_type_3d", "fine_raster.fragments", "Samples where a pixel has several"},
      {"prop__prop2zrop_samples_mode_earlyz", "depth.early_tested", ""},
      {"prop__prop2zrop_samples_mode_earlyz_op_killed", "depth.early_killed", ""},
      {"prop__prop2zrop_samples_mode_earlyz_op_passed", "depth.early_tested - depth.early_killed", ""},
      {"prop__prop2zrop_samples_mode_latez", "depth.late_tested", ""},
      {"prop__prop2zrop_samples_mode_latez_op_killed", "depth.late_killed_samples", ""},
      {"prop__prop2zrop_samples_mode_latez_op_passed", "depth.late_tested - depth.late_killed_samples", ""},
      {"prop__prop2crop_pixels", "rop.pixels_written", "Pixels that the ROP wrote, after late tests"},
      {"sm__ps_quads_launched", "warp_packer.quads", ""},
      {"sm__threads_launched_shader_ps_killmask_off", "core.fragments", "Live lanes, without helper lanes"},
      {"smsp__warps_launched", "core.vertex_warps + core.fragment_warps", ""},
      {"smsp__inst_executed", "core.instructions", "Of another instruction set"},
      {"smsp__thread_inst_executed", "core.lane_operations",
       "Lanes that executed something, arithmetic alone"},
      {"l1tex__texin_requests", "texture.requests", "A request of a warp here, of a quad or more there"},
      {"l1tex__t_requests", "texture.cache_requests", "Distinct lines of a request, looked up once each"},
      {"lts__t_requests", "l2.requests", ""},
      {"lts__t_sectors_lookup_hit", "l2.hits",
       "Requests, not sectors; merged ones are neither hits nor misses"},
      {"lts__t_sectors_lookup_miss", "l2.misses", "As lts__t_sectors_lookup_hit"},
      {"lts__t_sectors_srcunit_tex_lookup_miss", "memory.read_bytes / 32",
       "Sectors that any client missed, not texture units alone"},
      {"dram__bytes_read", "memory.read_bytes", ""},
      {"dram__bytes_write", "memory.write_bytes", ""},
      {"dram__bytes", "memory.read_bytes + memory.write_bytes", ""},
  };
}
// clang-format on

std::string as_text(const Profiler& p) {
  std::string text = fmt::format("{} [{}]\n", p.title, p.source);
  for (const VendorCounter& c : p.counters) {
    text += fmt::format("  {:<46} = {}\n", c.name, c.ours);
    if (!c.differs.empty()) text += fmt::format("  {:<46}   {}\n", "", c.differs);
  }
  return text;
}

std::string as_markdown(const Profiler& p) {
  std::string text =
      fmt::format("\n## {}\n\n`--as {}`, names from [{}](sources.md)\n\n", p.title, p.key, p.source);
  text += "| theirs | ours | what differs |\n|---|---|---|\n";
  for (const VendorCounter& c : p.counters)
    text += fmt::format("| `{}` | `{}` | {} |\n", c.name, c.ours, c.differs);
  return text;
}

}  // namespace

const std::vector<Profiler>& profilers() {
  static const std::vector<Profiler> kAll{
      {"arm", "Arm: Streamline, libGPUCounters", "Arm: counters", arm()},
      {"rgp", "AMD: Radeon GPU Profiler, GPUPerfAPI", "AMD: counters", rgp()},
      {"nsight", "NVIDIA: Nsight Graphics, Nsight Perf SDK", "NVIDIA: counters", nsight()}};
  return kAll;
}

std::vector<std::string> profiler_words() {
  std::vector<std::string> words;
  for (const Profiler& p : profilers()) words.emplace_back(p.key);
  words.emplace_back("all");
  return words;
}

std::string vendor_table(std::string_view word, bool markdown) {
  std::string text;
  if (markdown)
    text =
        "# Counters as profilers name them\n\nWhat the counters of real GPUs' profilers are here, where they "
        "mean the same, as `quadrille describe counters --as` lists them.\nA counter stands for its sum over "
        "all units of the kind ([counters](counters.md)); `frame` is that of the JSON "
        "([figures](figures.md)). What no unit here has, such as tessellation, has no row.\n";
  for (const Profiler& p : profilers())
    if (word == p.key || word == "all") text += markdown ? as_markdown(p) : as_text(p);
  return text;
}

}  // namespace quadrille::cli
