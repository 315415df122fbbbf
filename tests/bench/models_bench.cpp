/// Speed of the functions that a frame calls millions of times: coverage, interpolation, texturing, blending,
/// cache tags.
#include "models/cache/tag_array.h"
#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "models/raster/interpolate.h"
#include "models/rop/blend.h"
#include "models/rop/depth.h"
#include "models/texture/sample.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <memory>
#include <random>
#include <vector>

namespace {

using namespace quadrille::models;

TriangleSetup triangle_of_size(int pixels) {
  const auto at = [](float x, float y, float z) {
    return WindowVertex{static_cast<std::int32_t>(x * 256.0f), static_cast<std::int32_t>(y * 256.0f), z,
                        1.0f - 0.5f * z};
  };
  const auto size = static_cast<float>(pixels);
  const std::array<WindowVertex, 3> v{at(100.3f, 100.7f, 0.2f), at(100.3f + size, 130.0f, 0.5f),
                                      at(120.0f, 100.0f + size, 0.9f)};
  SetupState state;
  state.scissor = {0, 0, 1920, 1080};
  TriangleSetup t;
  (void)setup_triangle(v, whole_triangle_weights(), state, t);
  return t;
}

void setup(benchmark::State& state) {
  const std::array<WindowVertex, 3> v{WindowVertex{1000, 1000, 0.5f, 1.0f},
                                      WindowVertex{9000, 2000, 0.6f, 0.9f},
                                      WindowVertex{3000, 8000, 0.7f, 0.8f}};
  SetupState s;
  s.scissor = {0, 0, 1920, 1080};
  TriangleSetup t;
  for (auto _ : state) {
    benchmark::DoNotOptimize(setup_triangle(v, whole_triangle_weights(), s, t));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(setup);

void tile_walk(benchmark::State& state) {
  const TriangleSetup t = triangle_of_size(static_cast<int>(state.range(0)));
  std::int64_t tiles = 0;
  for (auto _ : state) {
    TileWalk walk(t);
    for (TileHit hit; walk.next(hit); ++tiles) benchmark::DoNotOptimize(hit);
  }
  state.SetItemsProcessed(tiles);
}
BENCHMARK(tile_walk)->Arg(12)->Arg(100)->Arg(900);

void coverage(benchmark::State& state) {
  const TriangleSetup t = triangle_of_size(static_cast<int>(state.range(0)));
  std::vector<TileHit> hits;
  TileWalk walk(t);
  for (TileHit hit; walk.next(hit);) hits.push_back(hit);
  for (auto _ : state) {
    for (const TileHit& hit : hits) benchmark::DoNotOptimize(tile_coverage(t, hit.tile_x, hit.tile_y));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hits.size()));
}
BENCHMARK(coverage)->Arg(12)->Arg(100);

void depths_of_tile(benchmark::State& state) {
  const TriangleSetup t = triangle_of_size(100);
  alignas(32) float out[64];
  for (auto _ : state) {
    tile_depths(t, 15, 15, out);
    benchmark::DoNotOptimize(out);
  }
}
BENCHMARK(depths_of_tile);

void depth_compare(benchmark::State& state) {
  alignas(32) float stored[64], incoming[64];
  for (int i = 0; i < 64; ++i) stored[i] = 0.5f, incoming[i] = static_cast<float>(i) / 64.0f;
  for (auto _ : state) {
    benchmark::DoNotOptimize(depth_test(CompareOp::kLess, stored, incoming, ~std::uint64_t{0}));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(depth_compare);

void interpolate(benchmark::State& state) {
  const TriangleSetup t = triangle_of_size(100);
  auto inputs = std::make_unique<FragmentInputs>();
  for (auto _ : state) {
    for (int slot = 0; slot < kWarpQuads; ++slot) interpolate_quad(t, 110 + 2 * slot, 120, slot, *inputs);
    benchmark::DoNotOptimize(*inputs);
  }
  state.SetItemsProcessed(state.iterations() * kWarpQuads);
}
BENCHMARK(interpolate);

/// Warps of 8 quads in a row or so, as a rasteriser makes them, on a 1024 x 1024 texture.
struct TextureScene {
  DeviceMemory memory;
  TextureView view;
  std::vector<TextureRequest> requests;
  SamplerState sampler;

  TextureScene(Format format, float texels_per_pixel) {
    std::vector<std::byte> texels;
    std::mt19937 random(1);
    for (std::uint32_t size = 1024; size >= 1; size /= 2) {
      for (std::uint32_t i = 0; i < size * size * 4; ++i) texels.push_back(static_cast<std::byte>(random()));
    }
    view = allocate_texture(memory, format, 1024, 1024, 11);
    tile_texture(memory, view, texels);
    const float step = texels_per_pixel / 1024.0f, c = 0.8f * step, s = 0.6f * step;
    for (int warp = 0; warp < 512; ++warp) {
      TextureRequest r;
      r.active = ~0u;
      r.op = Op::kTexImplicit;
      for (int lane = 0; lane < kWarpLanes; ++lane) {
        const int x = 8 * (warp % 64) + 2 * (lane / 4 % 4) + lane % 2,
                  y = 4 * (warp / 64) + 2 * (lane / 16) + lane / 2 % 2;
        r.u[static_cast<std::size_t>(lane)] = c * static_cast<float>(x) - s * static_cast<float>(y);
        r.v[static_cast<std::size_t>(lane)] = s * static_cast<float>(x) + c * static_cast<float>(y);
        r.lod[static_cast<std::size_t>(lane)] = 0;
      }
      requests.push_back(r);
    }
  }
};

void trilinear(benchmark::State& state, Format format, bool plan_only) {
  const TextureScene scene(format, static_cast<float>(state.range(0)) / 100.0f);
  auto plan = std::make_unique<TexturePlan>();
  alignas(64) std::array<LaneFloats, 4> rgba;
  std::int64_t lines = 0;
  for (auto _ : state) {
    for (const TextureRequest& request : scene.requests) {
      plan_texture(scene.view, scene.sampler, request, Precision{}, *plan);
      if (!plan_only) filter_texture(*plan, scene.memory, rgba);
      benchmark::DoNotOptimize(rgba);
      lines += plan->line_count;
    }
  }
  const auto warps = static_cast<double>(state.iterations()) * static_cast<double>(scene.requests.size());
  state.counters["lines/warp"] = static_cast<double>(lines) / warps;
  state.counters["ns/lane"] = benchmark::Counter(warps * kWarpLanes * 1e-9,
                                                 benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(trilinear, srgb, Format::kR8G8B8A8Srgb, false)->Arg(30)->Arg(140)->Arg(800);
BENCHMARK_CAPTURE(trilinear, unorm, Format::kR8G8B8A8Unorm, false)->Arg(30)->Arg(140)->Arg(800);
BENCHMARK_CAPTURE(trilinear, plan_only, Format::kR8G8B8A8Unorm, true)->Arg(30)->Arg(140)->Arg(800);

void blend(benchmark::State& state, bool enable, Format format) {
  BlendState s;
  s.enable = enable;
  s.src_color = BlendFactor::kSrcAlpha;
  s.dst_color = BlendFactor::kOneMinusSrcAlpha;
  s.src_alpha = BlendFactor::kOne;
  s.dst_alpha = BlendFactor::kOneMinusSrcAlpha;
  const float rgba[4][4] = {
      {0.1f, 0.2f, 0.3f, 0.4f}, {0.5f, 0.6f, 0.7f, 0.8f}, {0.9f, 1.0f, 0.0f, 0.1f}, {0.2f, 0.4f, 0.6f, 0.8f}};
  std::uint32_t pixels[4] = {0x80402010, 0xff00ff00, 0x12345678, 0x87654321};
  for (auto _ : state) {
    blend_quad(s, {}, format, rgba, nullptr, reinterpret_cast<std::byte*>(pixels), 0xf);
    benchmark::DoNotOptimize(pixels);
  }
}
BENCHMARK_CAPTURE(blend, opaque_srgb, false, Format::kR8G8B8A8Srgb);
BENCHMARK_CAPTURE(blend, alpha_srgb, true, Format::kR8G8B8A8Srgb);
BENCHMARK_CAPTURE(blend, alpha_unorm, true, Format::kR8G8B8A8Unorm);

void tag_hit(benchmark::State& state) {
  TagArray tags(4096, 16);
  for (std::uint32_t line = 0; line < 2048; ++line) benchmark::DoNotOptimize(tags.allocate(line));
  std::uint32_t line = 0;
  for (auto _ : state) {
    line = (line * 5 + 12345) & 2047;
    benchmark::DoNotOptimize(tags.lookup(line));
  }
}
BENCHMARK(tag_hit);

void tag_miss(benchmark::State& state) {
  TagArray tags(4096, 16);
  std::uint32_t line = 0;
  for (auto _ : state) {
    if (tags.lookup(++line) == TagArray::kNone) benchmark::DoNotOptimize(tags.allocate(line));
  }
}
BENCHMARK(tag_miss);

}  // namespace

BENCHMARK_MAIN();
