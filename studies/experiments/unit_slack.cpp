/// Frames that a unit works for but does not limit: another one, named in each, needs at least twice its
/// time.
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/unit_benchmarks.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

constexpr int kSteps = 64;

/// Every fragment reads the colour that it changes, a quad in two cycles of a ROP.
traces::CommandStream blended(std::uint32_t width, std::uint32_t height) {
  return stream_of(covered_frame(width, height, 16), {.blends = true});
}
/// The same with a depth test that passes.
traces::CommandStream blended_layers(std::uint32_t width, std::uint32_t height) {
  return stream_of(layers(width, height, 16, false), {.depth = true, .blends = true});
}
traces::CommandStream arithmetic(std::uint32_t width, std::uint32_t height) {
  return stream_of(covered_frame(width, height, 4), {.fragment_shader = chain_shader(4, kSteps)});
}
/// As `blended`, with a trilinear sample a fragment.
traces::CommandStream blended_samples(std::uint32_t width, std::uint32_t height) {
  const DrawTexture texture{64, 64, 2, traces::Filter::kLinear};
  return stream_of(
      covered_frame(width, height, 16),
      {.blends = true, .fragment_shader = sampling_shader(texture, {.level = 0.5}), .texture = texture});
}

/// As `blended`, with a word a fragment, from one line for a warp.
traces::CommandStream blended_loads(std::uint32_t width, std::uint32_t height) {
  return stream_of(covered_frame(width, height, 16),
                   {.blends = true,
                    .fragment_shader = storage_shader("o = vec4(b.w[uint(gl_FragCoord.x) % 8u], 0, 0, 0.5);"),
                    .storage_words = 8});
}

/// As `blended`, with a nearest sample a fragment of a texel that no other reads: all come from memory.
traces::CommandStream blended_texels(std::uint32_t width, std::uint32_t height) {
  const DrawTexture texture{16 * width, height};
  const TextureWalk walk{.triangle = static_cast<int>(width)};
  return stream_of(covered_frame(width, height, 16),
                   {.blends = true, .fragment_shader = sampling_shader(texture, walk), .texture = texture});
}

}  // namespace

std::vector<SlackFrame> slack_frames(std::uint32_t width, std::uint32_t height) {
  const std::vector<std::string> slow_rop{"rop.quads_per_clk=1"};
  const std::vector<std::string> slow_setup{"triangle_setup.drawn_per_clk=0.25"};
  const auto with = [](std::vector<std::string> settings, const char* more) {
    settings.emplace_back(more);
    return settings;
  };
  // The texture has 170 lines.
  const std::vector<std::string> small_l1 = with(slow_rop, "texture.cache_lines=32");
  const traces::CommandStream pixels = stream_of(pixel_triangles(width, height, 2));
  const traces::CommandStream culled =
      stream_of(pixel_triangles(width, height, 2), {.cull = traces::CullMode::kBack});
  const char* const by_setup = "triangles of a pixel; limit: set-up, four cycles each";
  const char* const by_rop = "the frame blended 16 times; limit: the ROPs, a quad in two cycles";
  const char* const by_cores = "four chains of 64 steps a fragment; limit: the cores";
  const char* const sampled = "trilinear samples, blended 16 times; limit: the ROPs, a quad in two cycles";
  return {
      {"command_processor",
       "32 draws that cover the frame; limit: the fine rasteriser",
       stream_of(covered_frame(width, height, 1), {.draws = 32}),
       {"command_processor.draw_clk=64"},
       "command_processor.draw_clk",
       64},
      {"vertex_fetch", by_setup, pixels, slow_setup, "vertex_fetch.indices_per_clk", 4},
      {"primitive_assembly", by_setup, pixels, with(slow_setup, "primitive_assembly.triangles_per_clk=2"),
       "primitive_assembly.triangles_per_clk", 2},
      {"clipper", by_setup, pixels, with(slow_setup, "clipper.triangles_per_clk=2"),
       "clipper.triangles_per_clk", 2},
      {"triangle_setup",
       "culled triangles; limit: vertex fetch, an index a cycle",
       culled,
       {"vertex_fetch.indices_per_clk=1"},
       "triangle_setup.culled_per_clk",
       1},
      {"coarse_raster",
       "the frame covered 32 times; limit: the fine rasteriser",
       stream_of(covered_frame(width, height, 32)),
       {},
       "coarse_raster.tests_per_clk",
       4},
      {"fine_raster", by_rop, blended(width, height), slow_rop, "fine_raster.quads_per_clk", 4},
      {"depth", "16 layers blended over each other; limit: the ROPs, a quad in two cycles",
       blended_layers(width, height), slow_rop, "depth.quads_per_clk", 4},
      {"warp_packer", by_rop, blended(width, height), slow_rop, "warp_packer.quads_per_clk", 4},
      {"work_distributor", by_rop, blended(width, height), slow_rop, "link.distributor_to_core.depth", 4},
      {"core", by_rop, blended(width, height), slow_rop, "core.simd_lanes", 8},
      {"texture", sampled, blended_samples(width, height), slow_rop, "texture.filter_quads_per_clk", 2},
      {"load_store", "a word of one line a fragment, blended 16 times; limit: the ROPs, a quad in two cycles",
       blended_loads(width, height), with(slow_rop, "load_store.lines_per_clk=2"), "load_store.lines_per_clk",
       2},
      {"rop", by_cores, arithmetic(width, height), {}, "rop.quads_per_clk", 4},
      {"l2", sampled, blended_samples(width, height), small_l1, "l2.hit_clk", 20},
      {"memory", "texels that are read once, blended 16 times; limit: the ROPs, a quad in two cycles",
       blended_texels(width, height), slow_rop, "gpu.memory_mhz", 1000},
      {"scan_out",
       "the frame covered 32 times, with its scan-out; limit: the fine rasteriser",
       stream_of(covered_frame(width, height, 32)),
       {},
       "scan_out.lines_in_flight",
       128},
  };
}

}  // namespace quadrille::studies::experiments
