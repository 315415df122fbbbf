/// Frames that one unit limits, and the arithmetic of each. Work over rate, and nothing else: what a frame
/// takes to begin and to end is not in it.
#include <fmt/format.h>

#include <functional>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/triangle_work.h"
#include "studies/experiments/unit_benchmarks.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

using pipeline::MachineConfig;
using Settings = std::vector<std::string>;

constexpr double kWarpQuads = 8, kWarpLanes = 32;
constexpr double kSectorBytes = 32;

Rates rates_of(const MachineConfig& m) {
  const auto u = [](int value) { return static_cast<std::uint32_t>(value); };
  return {.fine_quads = u(m.fine_raster.quads_per_clk),
          .tile_tests = u(m.coarse_raster.tests_per_clk),
          .pack_quads = u(m.warp_packer.quads_per_clk),
          .launch_clk = u(m.warp_packer.launch_clk),
          .batch_vertices = u(m.vertex_fetch.batch_vertices),
          .batch_triangles = u(m.vertex_fetch.batch_triangles),
          .triangle_slots = u(m.triangle_setup.triangle_slots),
          .walk_rows = u(m.coarse_raster.rows_per_clk),
          .walk_segments = u(m.coarse_raster.segments_per_clk),
          .walk_setup_clk = u(m.coarse_raster.walk_setup_clk)};
}

/// What a frame asks for, as numbers of floating point.
struct Work {
  double triangles = 0, batches = 0, fine_clk = 0, pack_clk = 0, quads = 0, tests = 0, warps = 0,
         walk_clk = 0;
};
Work work_on(const TriangleMesh& mesh, const MachineConfig& m) {
  const TriangleWork w = work_of(mesh, rates_of(m));
  const auto d = [](std::uint64_t value) { return static_cast<double>(value); };
  return {d(w.triangles), d(w.batches),    d(w.fine_clk),           d(w.pack_clk),
          d(w.quads),     d(w.tile_tests), d(w.quads) / kWarpQuads, w.walk_clk};
}

/// Collects frames; `cycles` computes from the mesh's work and the machine.
class Frames {
 public:
  using Cycles = std::function<double(const Work&, const MachineConfig&)>;

  void add(std::string_view unit, std::string what, std::string formula, const TriangleMesh& mesh,
           const DrawOptions& options, const Settings& settings, const Cycles& cycles,
           Share share = Share::kRender) {
    MachineConfig machine;
    apply_settings(machine, settings);
    machine.check();
    frames_.push_back({unit, std::move(what), std::move(formula), stream_of(mesh, options), settings,
                       cycles(work_on(mesh, machine), machine), share});
  }
  std::vector<LimitedFrame> take() { return std::move(frames_); }

 private:
  std::vector<LimitedFrame> frames_;
};

void add_front_end(Frames& frames, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t draws = width * height / 4;
  frames.add(
      "command_processor", fmt::format("{} draws of a triangle off screen", draws),
      "draws x (draw_clk + 1): the end of a draw is a token of its own",
      moved_right(same_triangle(width, height, 1), 2 * width), {.draws = draws}, {},
      [draws](const Work&, const MachineConfig& m) { return draws * (m.command_processor.draw_clk + 1.0); });
  frames.add("vertex_fetch", "culled triangles, an index a cycle", "indices / indices_per_clk",
             pixel_triangles(width, height, 2), {.cull = traces::CullMode::kBack},
             {"vertex_fetch.indices_per_clk=1"}, [](const Work& w, const MachineConfig& m) {
               return 3 * w.triangles / m.vertex_fetch.indices_per_clk;
             });
}

void add_geometry(Frames& frames, std::uint32_t width, std::uint32_t height) {
  frames.add("primitive_assembly", "culled triangles, what follows twice as fast",
             "(triangles + ends of batches) / triangles_per_clk", pixel_triangles(width, height, 6),
             {.cull = traces::CullMode::kBack},
             {"clipper.triangles_per_clk=2", "triangle_setup.culled_per_clk=2",
              "link.clipper_to_setup.width=2", "link.clipper_to_setup.depth=16"},
             [](const Work& w, const MachineConfig& m) {
               return (w.triangles + w.batches) / m.primitive_assembly.triangles_per_clk;
             });
  frames.add("clipper", "triangles with a corner before the near plane",
             "triangles x (clip_clk + 2 pieces / triangles_per_clk) + ends of batches / triangles_per_clk",
             repeated(through_near_plane(width, height, 1), 16), {.depth = true}, {},
             [](const Work& w, const MachineConfig& m) {
               const double piece = 1.0 / m.clipper.triangles_per_clk;
               return w.triangles * (m.clipper.clip_clk + 2 * piece) + w.batches * piece;
             });
  frames.add("triangle_setup", "triangles of a pixel, four cycles each",
             "triangles / drawn_per_clk + ends of batches", pixel_triangles(width, height, 2), {},
             {"triangle_setup.drawn_per_clk=0.25"}, [](const Work& w, const MachineConfig& m) {
               return w.triangles / m.triangle_setup.drawn_per_clk + w.batches;
             });
}

void add_raster(Frames& frames, std::uint32_t width, std::uint32_t height) {
  constexpr std::uint32_t kHidden = 256;
  const TriangleMesh shown = layers(width, height, 1, true);
  frames.add("coarse_raster", fmt::format("{} layers behind the first, a tile test a cycle", kHidden),
             "cycles of the fine rasteriser for the first layer + tile tests of the others / tests_per_clk",
             hidden_frame(width, height, kHidden), {.depth = true}, {"coarse_raster.tests_per_clk=1"},
             [&](const Work& w, const MachineConfig& m) {
               const Work first = work_on(shown, m);
               return first.fine_clk + (w.tests - first.tests) / m.coarse_raster.tests_per_clk;
             });
  frames.add("coarse_raster", "standing triangles a pixel wide, by edge walking",
             "rows / rows_per_clk + parts x walk_setup_clk, each triangle's tiles at its end",
             repeated(tiled_frame(width, height, 1, height), 2), {}, {"coarse_raster.traversal=edge_walking"},
             [](const Work& w, const MachineConfig&) { return w.walk_clk; });
  frames.add("fine_raster", "the frame covered 64 times",
             "quads of each tile / quads_per_clk, a cycle at least, + reports for the triangle store",
             covered_frame(width, height, 64), {}, {},
             [](const Work& w, const MachineConfig&) { return w.fine_clk; });
  frames.add("warp_packer", "the frame covered 32 times, a quad a cycle",
             "(quads of each tile / quads_per_clk + warps x launch_clk) / partitions",
             covered_frame(width, height, 32), {}, {"warp_packer.quads_per_clk=1"},
             [](const Work& w, const MachineConfig& m) { return w.pack_clk / m.gpu.partitions; });
}

void add_pixels(Frames& frames, std::uint32_t width, std::uint32_t height) {
  frames.add("depth", "the frame covered 64 times at one depth, a quad a cycle, without Hi-Z",
             "quads / quads_per_clk / partitions", covered_frame(width, height, 64), {.depth = true},
             {"depth.quads_per_clk=1", "coarse_raster.hiz=false"}, [](const Work& w, const MachineConfig& m) {
               return w.quads / m.depth.quads_per_clk / m.gpu.partitions;
             });
  frames.add(
      "rop", "the frame covered 32 times, a quad a cycle", "quads / quads_per_clk / partitions",
      covered_frame(width, height, 32), {}, {"rop.quads_per_clk=1"},
      [](const Work& w, const MachineConfig& m) { return w.quads / m.rop.quads_per_clk / m.gpu.partitions; });
  frames.add("rop", "the same, blended", "2 x quads / quads_per_clk / partitions",
             covered_frame(width, height, 16), {.blends = true}, {"rop.quads_per_clk=1"},
             [](const Work& w, const MachineConfig& m) {
               return 2 * w.quads / m.rop.quads_per_clk / m.gpu.partitions;
             });
  frames.add("rop", "the same, floats of 16 bits, 5 turns to blend", "5 x quads / quads_per_clk / partitions",
             covered_frame(width, height, 8), {.blends = true, .format = traces::Format::kR16G16B16A16Float},
             {"rop.quads_per_clk=1", "rop.half_blend_turns=5"}, [](const Work& w, const MachineConfig& m) {
               return m.rop.half_blend_turns * w.quads / m.rop.quads_per_clk / m.gpu.partitions;
             });
  frames.add("rop", "the same, two floats of 32 bits, 3 turns each",
             "3 x 2 x quads / quads_per_clk / partitions", covered_frame(width, height, 8),
             {.blends = true, .format = traces::Format::kR32G32Float},
             {"rop.quads_per_clk=1", "rop.float_blend_turns=3"}, [](const Work& w, const MachineConfig& m) {
               return 2 * m.rop.float_blend_turns * w.quads / m.rop.quads_per_clk / m.gpu.partitions;
             });
}

void add_cores(Frames& frames, std::uint32_t width, std::uint32_t height) {
  constexpr int kSteps = 256;
  const auto issue = [](int chains) {
    return [chains](const Work& w, const MachineConfig& m) {
      const double clk = kWarpLanes / m.core.simd_lanes;
      return w.warps * chain_instructions(chains, kSteps) * clk / (m.gpu.cores * m.core.simds);
    };
  };
  const TriangleMesh once = covered_frame(width, height, 1);
  frames.add(
      "work_distributor", "the frame covered 128 times, on 16 cores and 4 partitions of 16 quads a cycle",
      "warps, one a cycle", covered_frame(width, height, 128), {},
      {"gpu.cores=16", "gpu.partitions=4", "fine_raster.quads_per_clk=16", "warp_packer.quads_per_clk=16",
       "warp_packer.launch_clk=0", "depth.quads_per_clk=16", "rop.quads_per_clk=16"},
      [](const Work& w, const MachineConfig&) { return w.warps; });
  frames.add("core", "the frame covered 32 times, 8 bytes of colours a cycle and core",
             "warps x 32 x 4 / export_bytes_per_clk / cores", covered_frame(width, height, 32), {},
             {"core.export_bytes_per_clk=8"}, [](const Work& w, const MachineConfig& m) {
               return w.warps * kWarpLanes * 4 / m.core.export_bytes_per_clk / m.gpu.cores;
             });
  frames.add("core", fmt::format("four chains of {} steps", kSteps),
             "warps x instructions x 32 / simd_lanes / (cores x simds)", once,
             {.fragment_shader = chain_shader(4, kSteps)}, {}, issue(4));
  frames.add("core", "the same, one warp a SIMD", "the same: four chains hide each other's latency", once,
             {.fragment_shader = chain_shader(4, kSteps)}, {"core.warp_slots=4"}, issue(4));
  frames.add("core", fmt::format("one chain of {} steps, one warp a SIMD", kSteps),
             "warps x ((steps + 1) x alu_clk + 4 outputs x 32 / simd_lanes) / (cores x simds)", once,
             {.fragment_shader = chain_shader(1, kSteps)}, {"core.warp_slots=4"},
             [](const Work& w, const MachineConfig& m) {
               constexpr double kOutputs = 4;
               const double clk = (kSteps + 1) * m.core.alu_clk + kOutputs * kWarpLanes / m.core.simd_lanes;
               return w.warps * clk / (m.gpu.cores * m.core.simds);
             });
  const DrawTexture texture{64, 64, 2, traces::Filter::kLinear};
  frames.add("texture", "a trilinear sample a pixel, a quad a cycle",
             "quads x 2 levels / filter_quads_per_clk / cores", covered_frame(width, height, 32),
             {.fragment_shader = sampling_shader(texture, {.level = 0.5}), .texture = texture},
             {"texture.filter_quads_per_clk=1"}, [](const Work& w, const MachineConfig& m) {
               return 2 * w.quads / m.texture.filter_quads_per_clk / m.gpu.cores;
             });
  const DrawTexture blocks{4 * width, 4 * height, 1, traces::Filter::kNearest, traces::Format::kBc1RgbaUnorm};
  frames.add("texture", "every pixel a texel in a compressed block of its own, a block a cycle",
             "quads x 4 blocks / decode_blocks_per_clk / cores", covered_frame(width, height, 32),
             {.fragment_shader = sampling_shader(blocks, {.right = 4, .down = 4}), .texture = blocks},
             {"texture.decode_blocks_per_clk=1"}, [](const Work& w, const MachineConfig& m) {
               return 4 * w.quads / m.texture.decode_blocks_per_clk / m.gpu.cores;
             });
  const DrawTexture astc{4 * width, 4 * height, 1, traces::Filter::kNearest, traces::Format::kAstc4x4Unorm};
  frames.add("texture", "the same of ASTC, a block in two cycles",
             "quads x 4 blocks x astc_decode_slots / decode_blocks_per_clk / cores",
             covered_frame(width, height, 32),
             {.fragment_shader = sampling_shader(astc, {.right = 4, .down = 4}), .texture = astc},
             {"texture.decode_blocks_per_clk=1"}, [](const Work& w, const MachineConfig& m) {
               return 4 * w.quads * m.texture.astc_decode_slots / m.texture.decode_blocks_per_clk /
                      m.gpu.cores;
             });
}

/// A tile's first half, 8 x 4 pixels, is a warp.
void add_storage(Frames& frames, std::uint32_t width, std::uint32_t height) {
  constexpr std::uint32_t kWordsOfLine = 32;
  frames.add("load_store",
             "every lane of a warp loads from a line of its own, which the first-level cache holds",
             "warps x 32 lines / lines_per_clk / cores", covered_frame(width, height, 16),
             {.fragment_shader = storage_shader(
                  "o = vec4(b.w[32u * (uint(gl_FragCoord.x) % 8u + 8u * (uint(gl_FragCoord.y) % 4u))]);"),
              .storage_words = 32 * kWordsOfLine},
             {}, [](const Work& w, const MachineConfig& m) {
               return w.warps * kWarpLanes / m.load_store.lines_per_clk / m.gpu.cores;
             });
  frames.add("l2", "every fragment adds to one word", "fragments: a slice updates a word once a cycle",
             covered_frame(width, height, 4),
             {.fragment_shader = storage_shader("atomicAdd(b.w[0], 1u); o = vec4(1);"), .storage_words = 4},
             {}, [](const Work& w, const MachineConfig&) { return 4 * w.quads; });
}

void add_memory(Frames& frames, std::uint32_t width, std::uint32_t height) {
  const DrawTexture lines{8 * width, 4 * height, 1, traces::Filter::kNearest};
  frames.add("l2", "every pixel a texel in a line of its own, which only the L2 cache holds",
             "lines / channels, one a cycle and slice", covered_frame(width, height, 32),
             {.fragment_shader = sampling_shader(lines, {.right = 8, .down = 4}), .texture = lines},
             {"texture.cache_lines=64", "l2.cache_lines=16384"},
             [](const Work& w, const MachineConfig& m) { return 4 * w.quads / m.gpu.channels; });
  const DrawTexture sectors{4 * width, 2 * height, 1, traces::Filter::kNearest};
  frames.add("memory",
             "every pixel a texel in a sector of its own, which no cache holds, a bus a fourth as fast",
             "bytes / burst_bytes x t_burst / (channels x pseudo_channels), in cycles of the memory's clock",
             covered_frame(width, height, 4),
             {.fragment_shader = sampling_shader(sectors, {.right = 4, .down = 2}), .texture = sectors},
             {"texture.cache_lines=64", "l2.cache_lines=256", "memory.t_burst=8", "memory.t_ccd_s=8",
              "memory.t_ccd_l=8"},
             [](const Work& w, const MachineConfig& m) {
               const double bursts = 4 * w.quads * kSectorBytes / m.memory.burst_bytes;
               return bursts * m.memory.t_burst / (m.gpu.channels * m.memory.pseudo_channels) *
                      m.gpu.clock_mhz / m.gpu.memory_mhz;
             });
  const std::uint32_t wide = 4 * width, high = 4 * height;
  const double surface_lines = static_cast<double>(wide) * high / kWarpLanes;
  frames.add(
      "scan_out", fmt::format("{}x{} pixels that the L2 cache holds", wide, high),
      "lines of the surface, one a cycle, + the last line's way to the L2 cache and back",
      covered_frame(wide, high, 1), {}, {"l2.cache_lines=16384"},
      [=](const Work&, const MachineConfig& m) {
        return surface_lines + m.link.client_to_l2.latency + m.l2.hit_clk + m.link.l2_to_client.latency;
      },
      Share::kScanOut);
}

}  // namespace

std::vector<LimitedFrame> limited_frames(std::uint32_t width, std::uint32_t height) {
  Frames frames;
  add_front_end(frames, width, height);
  add_geometry(frames, width, height);
  add_raster(frames, width, height);
  add_pixels(frames, width, height);
  add_cores(frames, width, height);
  add_storage(frames, width, height);
  add_memory(frames, width, height);
  return frames.take();
}

}  // namespace quadrille::studies::experiments
