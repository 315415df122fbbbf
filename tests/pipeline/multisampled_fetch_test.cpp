/// Single samples of attachments, fetched by a later pass: the machine's pixels and laws, its own resolve,
/// the reference's picture, encoded lines, where samples lie, and what is refused.
#include "tests/pipeline/multisampled_fetch_stream.h"

#include "models/memory/surface.h"
#include "models/reference/compare.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/render.h"
#include "studies/given_reference.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

using namespace quadrille;
using namespace quadrille::pipeline::test;
using traces::Format;

namespace {

constexpr std::uint32_t kSampleCounts[] = {2, 4, 8};

std::vector<std::uint32_t> picture(std::uint64_t seed, const FetchWish& wish) {
  return pipeline::render_functional_frame(multisampled_fetch_stream(seed, wish), {}).image.color;
}

/// The largest difference of a component.
int farthest(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  REQUIRE(a.size() == b.size());
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 32; c += 8)
      most =
          std::max(most, std::abs(static_cast<int>(a[i] >> c & 255u) - static_cast<int>(b[i] >> c & 255u)));
  return most;
}

/// Images of all pixel sizes in turn.
FetchWish wish_of(std::uint64_t seed) {
  constexpr Format kColors[] = {Format::kR8G8B8A8Unorm, Format::kR16G16B16A16Float, Format::kR8Unorm,
                                Format::kR32G32B32A32Float};
  constexpr Format kIntegers[] = {Format::kR16G16B16A16Uint, Format::kR8Uint, Format::kR32G32B32A32Sint};
  FetchWish wish;
  wish.samples = kSampleCounts[seed % 3];
  wish.shows = seed % 4 == 0 ? FetchShows::kIntegers : FetchShows::kEverything;
  wish.color = kColors[seed % 4];
  wish.integers = kIntegers[seed / 4 % 3];
  wish.depth = seed % 2 == 0 ? Format::kD16Unorm : Format::kD32Float;
  return wish;
}

}  // namespace

TEST_CASE("multisampled fetch: random machines draw the functional run's pixels, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    INFO("stream and machine " << seed);
    CHECK(machine_faults(multisampled_fetch_stream(seed, wish_of(seed)), seed) == "");
  }
}

TEST_CASE("multisampled fetch: the mean of fetched samples is what the machine resolves them to") {
  for (const std::uint32_t samples : kSampleCounts) {
    FetchWish wish{.samples = samples, .shows = FetchShows::kMean};
    const auto fetched = picture(samples, wish);
    wish.shows = FetchShows::kResolved;
    CHECK(farthest(fetched, picture(samples, wish)) <= 1);
    CHECK(std::ranges::adjacent_find(fetched, std::not_equal_to<>()) != fetched.end());
  }
}

TEST_CASE("multisampled fetch: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const FetchWish wish = wish_of(seed);
    const auto pictures = studies::render_with_reference(multisampled_fetch_stream(seed, wish), {});
    const auto difference =
        models::reference::compare_images({kFetchWidth, kFetchHeight, pictures.machine.color},
                                          {kFetchWidth, kFetchHeight, pictures.reference.color});
    INFO("seed " << seed << ": " << difference.fraction_within(2));
    CHECK(difference.fraction_within(2) >= 0.999);
    if (wish.shows == FetchShows::kIntegers) CHECK(pictures.machine.color == pictures.reference.color);
  }
}

TEST_CASE("multisampled fetch: outside of image, layers and samples there is nothing, as in the reference") {
  for (const std::uint32_t samples : kSampleCounts) {
    const FetchWish wish{.samples = samples, .shows = FetchShows::kBeyond};
    const auto pictures = studies::render_with_reference(multisampled_fetch_stream(samples, wish), {});
    CHECK(std::ranges::all_of(pictures.machine.color, [](std::uint32_t c) { return c == 0xffffffffu; }));
    CHECK(pictures.machine.color == pictures.reference.color);
  }
}

TEST_CASE("multisampled fetch: encoded lines of samples are what later passes fetch") {
  const Settings both{{"depth.compression", "plane_offset"}, {"rop.compression", "samples_offset"}};
  Settings little_cache = both;
  little_cache.insert(little_cache.end(), {{"rop.cache_lines", "8"}, {"rop.cache_ways", "4"}});
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("stream " << seed);
    const traces::CommandStream stream = multisampled_fetch_stream(seed, wish_of(seed));
    CHECK(faults_on(both, stream) == "");
    CHECK(faults_on(little_cache, stream) == "");
    CHECK(faults_on({}, stream) == "");
  }
  // The machine of this seed encodes both.
  const hw::contract::Outcome outcome =
      hw::contract::run_forked(machine_builder(multisampled_fetch_stream(1), 5), {});
  std::int64_t reads = 0;
  for (const auto& [name, value] : outcome.figures)
    if (name.find("texture") != std::string::npos && name.ends_with("encoded_reads")) reads += value;
  CHECK(reads > 0);
}

TEST_CASE("multisampled fetch: a view finds each sample in its tile's plane, and in all layers") {
  for (const Format format : {Format::kR8Unorm, Format::kR8G8B8A8Unorm, Format::kR32G32B32A32Float}) {
    const traces::CommandStream stream = multisampled_fetch_stream(1, {.samples = 8, .color = format});
    pipeline::DeviceFrame frame(std::uint64_t{1} << 28);
    pipeline::build_frame(stream, {}, frame);
    const auto& textures = frame.frame.draws.back().fragment.textures;
    const models::TextureView& layers =
        textures[0].view.kind == models::ViewKind::k2DMultisampledArray ? textures[0].view : textures[1].view;
    REQUIRE(layers.layout.samples == 8);
    const std::uint32_t bytes = models::format_bytes(format);
    for (std::uint32_t layer = 0; layer < 2; ++layer) {
      const models::SurfaceLayout& surface = frame.frame.passes[layer].color[0].surface;
      for (std::uint32_t sample = 0; sample < 8; ++sample)
        for (std::uint32_t y = 0; y < kFetchHeight; ++y)
          for (std::uint32_t x = 0; x < kFetchWidth; x += 3) {
            const std::uint64_t index =
                layers.layout.texel_index(0, x, y, layer) + layers.layout.sample_part(sample);
            const std::uint64_t in_tile = surface.pixel_address(x, y) - surface.tile_address(x / 8, y / 8);
            REQUIRE(layers.base + bytes * index == surface.tile_address(x / 8, y / 8, sample) + in_tile);
          }
    }
  }
}

TEST_CASE("multisampled fetch: samplers have no say, and may be missing") {
  const traces::CommandStream stream = multisampled_fetch_stream(2);
  traces::CommandStream without = stream;
  for (std::size_t t = 0; t < 4; ++t) without.descriptor_sets[0].textures[t].sampler = traces::kNone;
  CHECK(refusal(without).empty());
  CHECK(functional_digest(without) == functional_digest(stream));
  CHECK(studies::render_with_reference(without, {}).reference.color ==
        studies::render_with_reference(stream, {}).reference.color);
}

TEST_CASE("multisampled fetch: streams survive their trace file") {
  const traces::CommandStream stream = multisampled_fetch_stream(3);
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}

TEST_CASE("multisampled fetch: what no pass has stored, or another kind of view, is refused in one line") {
  const auto damaged = [](const auto& damage) {
    traces::CommandStream stream = multisampled_fetch_stream(1);
    damage(stream);
    std::string said = refusal(stream);
    CHECK(said.find('\n') == std::string::npos);
    return said;
  };
  const auto pass = [](traces::CommandStream& stream) -> traces::BeginPass& {
    return std::get<traces::BeginPass>(stream.commands[0]);
  };
  CHECK(damaged([](auto&) {}).empty());
  CHECK_THAT(damaged([&](auto& s) { pass(s).colors[0].store = traces::StoreOp::kDiscard; }),
             Catch::Contains("samples level 0 of layer 1 of image 0 '0' before a pass has stored it"));
  CHECK_THAT(damaged([](auto& s) { s.descriptor_sets[0].textures[0].view = traces::ViewKind::k2D; }),
             Catch::Contains("a view '2d' of image 0 '0' of 4 samples a pixel"));
  CHECK_THAT(
      damaged([](auto& s) { s.descriptor_sets[0].textures[4].view = traces::ViewKind::k2DMultisampled; }),
      Catch::Contains("a view '2d-ms' of image 3 '3' of 1 samples a pixel"));
  CHECK_THAT(damaged([](auto& s) { s.images[2].usage = traces::kDepthAttachment; }),
             Catch::Contains("image 2 '2' is not for sampling"));
  CHECK_THAT(damaged([](auto& s) {
               s.descriptor_sets[0].textures[0].view = traces::ViewKind::k2DMultisampledArray;
             }),
             Catch::Contains("samples a view '2d-ms' at set 0, binding 0, where one '2d-ms-array' is bound"));
}
