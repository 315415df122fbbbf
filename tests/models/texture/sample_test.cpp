#include "models/texture/sample.h"

#include "tests/models/random_source.h"
#include "tests/models/texture/scalar_sampler.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>

using namespace quadrille::models;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

PlainTexture random_texture(RandomSource& random, Format format, std::uint32_t width, std::uint32_t height,
                            bool mipmapped) {
  PlainTexture t{format, width, height, 1, {}};
  if (mipmapped) t.levels = static_cast<std::uint32_t>(std::bit_width(std::max(width, height)));
  for (std::uint32_t level = 0; level < t.levels; ++level) {
    for (std::uint32_t i = 0; i < 4 * t.level_width(level) * t.level_height(level); ++i)
      t.texels.push_back(static_cast<std::byte>(random.bits()));
  }
  return t;
}

SamplerState random_sampler(RandomSource& random) {
  const auto filter = [&] { return static_cast<Filter>(random.integer(0, 1)); };
  SamplerState s{filter(),
                 filter(),
                 filter(),
                 static_cast<Wrap>(random.integer(0, static_cast<int>(kLastWrap))),
                 static_cast<Wrap>(random.integer(0, static_cast<int>(kLastWrap))),
                 0,
                 0,
                 1000,
                 static_cast<BorderColor>(random.integer(0, 2))};
  if (random.integer(0, 2) == 0) s.lod_bias = random.real(-3, 3);
  if (random.integer(0, 2) == 0) s.min_lod = random.real(0, 2);
  if (random.integer(0, 2) == 0) s.max_lod = s.min_lod + random.real(0, 3);
  return s;
}

/// Quads at random places, each with its own scale and direction.
TextureRequest random_request(RandomSource& random, std::uint32_t width, std::uint32_t height) {
  TextureRequest r;
  r.op = std::array{Op::kTexImplicit, Op::kTexImplicit, Op::kTexBias,
                    Op::kTexLod}[static_cast<std::size_t>(random.integer(0, 3))];
  r.active = random.integer(0, 1) != 0 ? ~0u : random.bits();
  for (std::size_t quad = 0; quad < kWarpQuads; ++quad) {
    const float step = std::exp2(random.real(-3, 7)), u0 = random.real(-3, 3), v0 = random.real(-3, 3);
    const float dx = random.real(-1, 1) * step, dy = random.real(-1, 1) * step,
                ex = random.real(-1, 1) * step, ey = random.real(-1, 1) * step;
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
      const std::size_t column = pixel % 2, row = pixel / 2;
      const auto x = static_cast<float>(column), y = static_cast<float>(row);
      r.u[4 * quad + pixel] = u0 + (x * dx + y * ex) / static_cast<float>(width);
      r.v[4 * quad + pixel] = v0 + (x * dy + y * ey) / static_cast<float>(height);
      r.lod[4 * quad + pixel] = random.real(-2, 6);
    }
  }
  return r;
}

std::array<LaneFloats, 4> sampled(const TextureView& view, const SamplerState& s, const TextureRequest& r,
                                  const DeviceMemory& memory, const Precision& precision = {}) {
  auto plan = std::make_unique<TexturePlan>();
  plan_texture(view, s, r, precision, *plan);
  std::array<LaneFloats, 4> rgba;
  filter_texture(*plan, memory, rgba);
  return rgba;
}

TextureView upload(DeviceMemory& memory, const PlainTexture& t, Tiling tiling = Tiling::kTiled) {
  const TextureView view = allocate_texture(memory, t.format, {t.width, t.height}, t.levels, tiling);
  tile_texture(memory, view, t.texels);
  return view;
}

constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 9> kSizes{
    {{256, 256}, {211, 211}, {1, 1}, {1, 64}, {53, 1}, {2, 2}, {3, 200}, {128, 32}, {300, 7}}};

}  // namespace

TEST_CASE("sample: agrees with a sampler written in double for every size and state") {
  RandomSource random(111);
  std::size_t lanes = 0, close = 0;
  for (int round = 0; round < 4000; ++round) {
    const auto [width, height] = kSizes[static_cast<std::size_t>(round) % kSizes.size()];
    const Format format = random.integer(0, 1) != 0 ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm;
    const PlainTexture texture = random_texture(random, format, width, height, random.integer(0, 3) != 0);
    DeviceMemory memory;
    (void)memory.allocate(static_cast<std::uint64_t>(random.integer(0, 1000)));
    const TextureView view = upload(memory, texture);
    const SamplerState state = random_sampler(random);
    const Precision precision{8, random.integer(1, 8), random.integer(1, 8)};
    const ScalarSampler ruler(texture, state, precision);
    const TextureRequest request = random_request(random, width, height);
    const auto rgba = sampled(view, state, request, memory, precision);
    // A coordinate or level at the boundary of its grid may round the other way: one step of the grid, or
    // another texel when nothing is filtered.
    const double step = 2.0 / (1 << precision.subtexel_bits) + 1.0 / (1 << precision.lod_bits);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      if ((request.active >> lane & 1) == 0) continue;
      const Color expected = ruler.sample(static_cast<double>(request.u[lane]),
                                          static_cast<double>(request.v[lane]), ruler.lambda(request, lane));
      double error = 0;
      for (std::size_t c = 0; c < 4; ++c)
        error = std::max(error, std::abs(static_cast<double>(rgba[c][lane]) - expected[c]));
      ++lanes;
      close += error < 2e-6 ? 1 : 0;
      const bool all_linear =
          state.mag == Filter::kLinear && state.min == Filter::kLinear && state.mip == Filter::kLinear;
      if (all_linear && error > step) FAIL("round " << round << " lane " << lane << " error " << error);
    }
  }
  CHECK(lanes > 80000);
  CHECK(static_cast<double>(close) > 0.997 * static_cast<double>(lanes));
}

TEST_CASE("sample: integers that look like signalling NaNs keep every bit") {
  RandomSource random(113);
  for (const std::uint32_t value : {0x7f800001u, 0xffabcdefu, 0x7fbfffffu, 0x80000000u}) {
    PlainTexture texture{Format::kR32Uint, 8, 8, 1, {}};
    texture.texels.resize(4 * 64);
    for (std::size_t i = 0; i < 64; ++i) std::memcpy(texture.texels.data() + 4 * i, &value, 4);
    DeviceMemory memory;
    const TextureView view = upload(memory, texture);
    const SamplerState nearest{Filter::kNearest, Filter::kNearest, Filter::kNearest};
    const TextureRequest request = random_request(random, 8, 8);
    const auto rgba = sampled(view, nearest, request, memory);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane)
      if ((request.active >> lane & 1) != 0) CHECK(std::bit_cast<std::uint32_t>(rgba[0][lane]) == value);
  }
}

TEST_CASE("sample: a constant texture filters to itself") {
  RandomSource random(112);
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t value = random.bits();
    PlainTexture texture =
        random_texture(random, round % 2 == 0 ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm, 37, 64, true);
    for (std::size_t i = 0; i < texture.texels.size(); ++i)
      texture.texels[i] = static_cast<std::byte>(value >> (8 * (i % 4)));
    DeviceMemory memory;
    const TextureView view = upload(memory, texture);
    const TextureRequest request = random_request(random, 37, 64);
    SamplerState sampler = random_sampler(random);
    for (Wrap* const wrap : {&sampler.wrap_u, &sampler.wrap_v})
      if (*wrap == Wrap::kClampToBorder) *wrap = Wrap::kRepeat;
    const auto rgba = sampled(view, sampler, request, memory);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      if ((request.active >> lane & 1) == 0) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        const auto code = static_cast<std::uint8_t>(value >> (8 * c));
        const float expected =
            c < 3 && round % 2 == 0 ? decode_srgb8(code) : static_cast<float>(code) / 255.0f;
        if (rgba[c][lane] != expected) FAIL("round " << round << " lane " << lane << " component " << c);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("sample: the order in which texels lie changes no bit of what is sampled") {
  RandomSource random(118);
  for (int round = 0; round < 1500; ++round) {
    const auto [width, height] = kSizes[static_cast<std::size_t>(round) % kSizes.size()];
    const Format format = round % 2 != 0 ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm;
    const PlainTexture texture = random_texture(random, format, width, height, true);
    TextureRequest request = random_request(random, width, height);
    SamplerState sampler = random_sampler(random);
    if (round % 3 == 0) sampler.max_anisotropy = random.real(1, 16);
    TextureOperation gather;
    gather.ask = TextureAsk::kGather;
    if (round % 5 == 0) request.operation = &gather;
    DeviceMemory memory;
    const auto tiled = sampled(upload(memory, texture), sampler, request, memory);
    for (const Tiling tiling : {Tiling::kLinear, Tiling::kMorton, Tiling::kWilliams}) {
      const auto other = sampled(upload(memory, texture, tiling), sampler, request, memory);
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t lane = 0; lane < kWarpLanes; ++lane)
          if ((request.active >> lane & 1) != 0 && tiled[c][lane] != other[c][lane])
            FAIL("round " << round << ", order " << static_cast<int>(tiling) << ", lane " << lane);
    }
  }
  SUCCEED();
}

TEST_CASE("sample: the plan lists each touched line once with exactly the sectors that are read") {
  RandomSource random(113);
  auto plan = std::make_unique<TexturePlan>();
  std::size_t most = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto [width, height] = kSizes[static_cast<std::size_t>(round) % kSizes.size()];
    DeviceMemory memory;
    (void)memory.allocate(static_cast<std::uint64_t>(random.integer(0, 1000)));
    const TextureView view =
        upload(memory, random_texture(random, Format::kR8G8B8A8Unorm, width, height, true),
               static_cast<Tiling>(round / 9 % 4));
    const int row_shift = view.layout.plane_row_shift();
    const auto addresses = [&](std::int32_t texel) {
      const auto index = static_cast<std::uint32_t>(texel);
      std::vector<std::uint64_t> bytes{view.base + 4 * std::uint64_t{index}};
      if (row_shift != 0) bytes = {view.base + index};
      for (std::uint32_t c = 1; row_shift != 0 && c < 4; ++c)
        bytes.push_back(view.base + plane_index(index, row_shift, c));
      return bytes;
    };
    const TextureRequest request = random_request(random, width, height);
    const SamplerState sampler = random_sampler(random);
    plan_texture(view, sampler, request, {}, *plan);
    std::map<std::uint32_t, std::uint32_t> expected;
    std::uint32_t quads = 0;
    for (std::size_t group = 0; group < 4; ++group) {
      for (std::size_t level = 0; level < plan->levels[group]; ++level) {
        std::uint32_t used = 0;
        for (std::size_t i = 0; i < 8; ++i) {
          const std::size_t lane = 8 * group + i;
          if ((request.active >> lane & 1) == 0 || (level == 1 && plan->level_weight[lane] == 0.0f)) continue;
          used |= 1u << i;
          const TexturePlan::Footprint& f = plan->footprint[group][level];
          for (std::size_t corner = 0; corner < 4; ++corner) {
            if ((f.border >> (8 * corner + i) & 1) != 0) continue;
            for (const std::uint64_t address : addresses(f.texel[corner][i]))
              expected[static_cast<std::uint32_t>(address / 128)] |= 1u << (address / 32 % 4);
          }
        }
        quads += ((used & 15) != 0 ? 1u : 0u) + ((used >> 4) != 0 ? 1u : 0u);
      }
    }
    REQUIRE(static_cast<std::size_t>(plan->line_count) == expected.size());
    most = std::max(most, expected.size());
    for (int i = 0; i < plan->line_count; ++i) {
      const TextureLine& line = plan->lines[static_cast<std::size_t>(i)];
      REQUIRE(expected.at(line.line) == line.sectors);
    }
    if (request.active != 0 && !has_border(sampler))
      REQUIRE(plan->lines[0].line ==
              addresses(plan->footprint[static_cast<std::size_t>(std::countr_zero(request.active)) / 8][0]
                            .texel[0][static_cast<std::size_t>(std::countr_zero(request.active)) % 8])[0] /
                  128);
    REQUIRE(plan->bilinear_quads == quads);
    REQUIRE(plan->magnified_lanes + plan->minified_lanes ==
            static_cast<std::uint32_t>(std::popcount(request.active)));
  }
  CHECK(most > 50);
}

TEST_CASE("sample: hostile coordinates read inside the texture and count as zero when not finite") {
  RandomSource random(114);
  const float hostile[] = {kNan,  kInf, -kInf, 3e38f,  -3e38f,  1e9f,        -1e9f, 8388609.0f,
                           -0.0f, 1.0f, -1.0f, 1e-40f, -1e-10f, 0.99999994f, 2.0f,  -2.0f};
  for (int round = 0; round < 3000; ++round) {
    const auto [width, height] = kSizes[static_cast<std::size_t>(round) % kSizes.size()];
    const PlainTexture texture = random_texture(random, Format::kR8G8B8A8Unorm, width, height, true);
    DeviceMemory memory;
    const TextureView view = upload(memory, texture);
    TextureRequest r = random_request(random, width, height);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      if (random.integer(0, 1) != 0) r.u[lane] = hostile[random.integer(0, 15)];
      if (random.integer(0, 1) != 0) r.v[lane] = hostile[random.integer(0, 15)];
      if (random.integer(0, 3) == 0) r.lod[lane] = hostile[random.integer(0, 15)];
    }
    const SamplerState s = random_sampler(random);
    auto plan = std::make_unique<TexturePlan>();
    plan_texture(view, s, r, {}, *plan);
    for (std::size_t group = 0; group < 4; ++group) {
      for (std::size_t level = 0; level < plan->levels[group]; ++level) {
        for (const auto& corner : plan->footprint[group][level].texel) {
          for (const std::int32_t texel : corner) {
            if (texel < 0 || 4 * static_cast<std::uint64_t>(texel) >= view.layout.bytes)
              FAIL("round " << round << " texel " << texel);
          }
        }
      }
    }
    TextureRequest zeroed = r;
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      for (LaneFloats* row : {&zeroed.u, &zeroed.v, &zeroed.lod}) {
        if (!std::isfinite((*row)[lane])) (*row)[lane] = 0.0f;
      }
    }
    const auto a = sampled(view, s, r, memory), b = sampled(view, s, zeroed, memory);
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
        if (!std::isfinite(a[c][lane]) || a[c][lane] < 0.0f || a[c][lane] > 1.0f)
          FAIL("round " << round << ": " << a[c][lane]);
        if (a[c][lane] != b[c][lane])
          FAIL("round " << round << " lane " << lane << ": not finite is not zero");
      }
    }
  }
  SUCCEED();
}

TEST_CASE("sample: a quad's result does not depend on the other quads or on inactive lanes") {
  RandomSource random(115);
  const PlainTexture texture = random_texture(random, Format::kR8G8B8A8Srgb, 211, 130, true);
  DeviceMemory memory;
  const TextureView view = upload(memory, texture);
  for (int round = 0; round < 2000; ++round) {
    SamplerState s = random_sampler(random);
    if (round % 2 != 0) {  // samples along an axis, by quad
      s.mag = s.min = Filter::kLinear;
      s.max_anisotropy = random.real(1, 16);
    }
    const TextureRequest r = random_request(random, 211, 130);
    TextureRequest moved = random_request(random, 211, 130);
    moved.op = r.op;
    const auto from = static_cast<std::size_t>(random.integer(0, 7)),
               to = static_cast<std::size_t>(random.integer(0, 7));
    const std::uint32_t active = r.active >> (4 * from) & 15;
    moved.active = (moved.active & ~(15u << (4 * to))) | active << (4 * to);
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
      moved.u[4 * to + pixel] = r.u[4 * from + pixel];
      moved.v[4 * to + pixel] = r.v[4 * from + pixel];
      moved.lod[4 * to + pixel] = r.lod[4 * from + pixel];
    }
    const auto a = sampled(view, s, r, memory), b = sampled(view, s, moved, memory);
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
      if ((active >> pixel & 1) == 0) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        if (a[c][4 * from + pixel] != b[c][4 * to + pixel]) FAIL("round " << round << " pixel " << pixel);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("sample: one texel a pixel is level 0 and two is level 1 and neither mixes") {
  RandomSource random(116);
  const PlainTexture texture = random_texture(random, Format::kR8G8B8A8Unorm, 64, 64, true);
  DeviceMemory memory;
  const TextureView view = upload(memory, texture);
  auto plan = std::make_unique<TexturePlan>();
  for (const auto& [step, level, magnified] :
       {std::tuple{0.5f, 0, 32u}, {1.0f, 0, 32u}, {2.0f, 1, 0u}, {8.0f, 3, 0u}, {1e6f, 6, 0u}}) {
    TextureRequest r = random_request(random, 64, 64);
    r.op = Op::kTexImplicit;
    r.active = ~0u;
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      r.u[lane] = static_cast<float>(lane % 2) * step / 64.0f;
      r.v[lane] = static_cast<float>(lane / 2 % 2) * step / 64.0f;
    }
    plan_texture(view, SamplerState{}, r, {}, *plan);
    CHECK(plan->magnified_lanes == magnified);
    CHECK(plan->minified_lanes == 32 - magnified);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      CHECK(plan->finer_level[lane] == level);
      CHECK(plan->level_weight[lane] == 0.0f);
    }
    CHECK(plan->bilinear_quads == 8);
    CHECK(plan->texels == 128);
  }
}

TEST_CASE("sample: work is counted by quad and level and texel") {
  RandomSource random(117);
  const PlainTexture texture = random_texture(random, Format::kR8G8B8A8Unorm, 64, 64, true);
  DeviceMemory memory;
  const TextureView view = upload(memory, texture);
  auto plan = std::make_unique<TexturePlan>();
  TextureRequest r = random_request(random, 64, 64);
  r.op = Op::kTexLod;
  r.active = 0x0000f013;  // two lanes of quad 0, one of quad 1, four of quad 3
  r.lod.fill(1.5f);
  plan_texture(view, SamplerState{}, r, {}, *plan);
  CHECK(plan->bilinear_quads == 6);
  CHECK(plan->texels == 7 * 4 * 2);
  CHECK(plan->levels == std::array<std::uint8_t, 4>{2, 2, 0, 0});
  SamplerState nearest;
  nearest.min = nearest.mip = Filter::kNearest;
  plan_texture(view, nearest, r, {}, *plan);
  CHECK(plan->bilinear_quads == 3);
  CHECK(plan->texels == 7);
  CHECK(plan->finer_level[0] == 1);  // 1.5 is half way: the specification's rounding takes the finer one
  r.active = 0;
  plan_texture(view, nearest, r, {}, *plan);
  CHECK(plan->line_count == 0);
  CHECK(plan->bilinear_quads == 0);
}

TEST_CASE("sample: a footprint takes as many samples as it is longer than wide, in the level of its width") {
  RandomSource random(118);
  const PlainTexture texture = random_texture(random, Format::kR8G8B8A8Unorm, 64, 64, true);
  DeviceMemory memory;
  const TextureView view = upload(memory, texture);
  auto plan = std::make_unique<TexturePlan>();
  // texels along x and y, samples allowed; samples taken, level
  for (const auto& [x, y, most, samples, level] : {std::tuple{8.0f, 1.0f, 16.0f, 8u, 0},
                                                   {8.0f, 1.0f, 4.0f, 4u, 1},
                                                   {2.0f, 32.0f, 16.0f, 16u, 1},
                                                   {4.0f, 4.0f, 16.0f, 1u, 2},
                                                   {0.5f, 0.1f, 16.0f, 1u, 0}}) {
    TextureRequest r = random_request(random, 64, 64);
    r.op = Op::kTexImplicit;
    r.active = ~0u;
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      r.u[lane] = static_cast<float>(lane % 2) * x / 64.0f;
      r.v[lane] = static_cast<float>(lane / 2 % 2) * y / 64.0f;
    }
    SamplerState sampler;
    sampler.max_anisotropy = most;
    for (const auto footprint :
         {AnisotropicFootprint::kLongerDifference, AnisotropicFootprint::kEllipseAxis}) {
      plan_texture(view, sampler, r, {.anisotropic_footprint = footprint}, *plan);
      INFO(x << " x " << y << " texels, at most " << most << " samples");
      CHECK(plan->bilinear_quads == 8 * samples);
      CHECK(plan->texels == 128 * samples);
      CHECK(plan->finer_level[0] == level);
      CHECK(plan->level_weight[0] == 0.0f);
    }
  }
}
