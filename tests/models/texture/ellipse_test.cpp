/// Ellipses of texels: which texels have a weight, how many footprints hold them, and what a request reads.
#include "models/texture/ellipse_texels.h"

#include "models/texture/sample.h"
#include "tests/models/random_source.h"
#include "tests/models/texture/scalar_sampler.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

using namespace quadrille::models;

namespace {

using Footprints = std::array<EllipseFootprint, kMaxEllipseFootprints>;
using Texel = std::pair<std::int32_t, std::int32_t>;

/// Weights by texel; a texel must not be named twice with a weight.
std::map<Texel, float> texels_of(const TexelEllipse& ellipse, float x, float y) {
  Footprints footprints;
  const int count = ellipse_footprints(ellipse, x, y, footprints);
  std::map<Texel, float> texels;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const EllipseFootprint& f = footprints[i];
    CHECK(*std::max_element(f.weight.begin(), f.weight.end()) > 0);
    for (int corner = 0; corner < 4; ++corner) {
      const float weight = f.weight[static_cast<std::size_t>(corner)];
      if (weight > 0) CHECK(texels.emplace(Texel{f.column + corner % 2, f.row + corner / 2}, weight).second);
    }
  }
  return texels;
}

/// Two changes at right angles of such lengths, turned by an angle.
TexelEllipse turned(float longer, float shorter, float angle, float most) {
  const float c = std::cos(angle), s = std::sin(angle);
  return texel_ellipse({longer * c, longer * s}, {-shorter * s, shorter * c}, most);
}

/// A request of which every quad has the same changes, in texels of a texture of 64 x 64.
TextureRequest stretched(float x, float y) {
  TextureRequest r;
  r.op = Op::kTexImplicit;
  r.active = ~0u;
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    r.u[lane] = 0.5f + static_cast<float>(lane % 2) * x / 64.0f;
    r.v[lane] = 0.5f + static_cast<float>(lane / 2 % 2) * y / 64.0f;
  }
  return r;
}

PlainTexture plain_texture(RandomSource& random, bool constant) {
  PlainTexture t{Format::kR8G8B8A8Unorm, 64, 64, 7, {}};
  for (std::uint32_t level = 0; level < t.levels; ++level)
    for (std::uint32_t i = 0; i < 4 * t.level_width(level) * t.level_height(level); ++i)
      t.texels.push_back(static_cast<std::byte>(constant ? 40 * (i % 4 + 1) : random.bits()));
  return t;
}

TextureView upload(DeviceMemory& memory, const PlainTexture& t) {
  const TextureView view = allocate_texture(memory, t.format, t.width, t.height, t.levels);
  tile_texture(memory, view, t.texels);
  return view;
}

constexpr Precision kEllipse{.anisotropic_footprint = AnisotropicFootprint::kEllipse};

}  // namespace

TEST_CASE("ellipse: a pixel without changes weighs its texel and what lies within one texel") {
  const auto texels = texels_of(texel_ellipse({0, 0}, {0, 0}, 16), 5.0f, 7.0f);
  CHECK(texels.size() == 5);
  CHECK(texels.at({5, 7}) == 1.0f);
  for (const Texel& beside : {Texel{4, 7}, {6, 7}, {5, 6}, {5, 8}})
    CHECK(texels.at(beside) == Approx(std::exp(-2.0)).epsilon(1e-6));
  CHECK(texels_of(texel_ellipse({0, 0}, {0, 0}, 16), 5.5f, 7.5f).size() == 4);
}

TEST_CASE("ellipse: texels weigh exp(-2 r^2), r being the way to the edge") {
  RandomSource random(401);
  for (int i = 0; i < 400; ++i) {
    const std::array<float, 2> along_x{random.real(-9, 9), random.real(-2, 2)},
        along_y{random.real(-2, 2), random.real(-1, 1)};
    const float x = random.real(-40, 40), y = random.real(-40, 40);
    // J J' + 1, and its inverse, where neither a limit nor the greatest anisotropy is met.
    const double uu = along_x[0] * along_x[0] + along_y[0] * along_y[0] + 1.0,
                 vv = along_x[1] * along_x[1] + along_y[1] * along_y[1] + 1.0,
                 uv = along_x[0] * along_x[1] + along_y[0] * along_y[1];
    const double det = uu * vv - uv * uv, root = std::hypot(uu - vv, 2 * uv);
    if ((uu + vv - root) / 2 - 1 > 3.9 || (uu + vv + root) / (uu + vv - root) > 200) continue;
    const auto texels = texels_of(texel_ellipse(along_x, along_y, 16), x, y);
    for (std::int32_t row = -60; row <= 60; ++row)
      for (std::int32_t column = -60; column <= 60; ++column) {
        const double u = column - static_cast<double>(x), v = row - static_cast<double>(y);
        const double r2 = (u * u * vv - 2 * u * v * uv + v * v * uu) / det;
        const auto found = texels.find({column, row});
        if (r2 < 1.0) {
          REQUIRE(found != texels.end());
          CHECK(found->second == Approx(std::exp(-2 * r2)).epsilon(2.5e-3));
        }
        if (r2 > 1.002) CHECK(found == texels.end());
      }
  }
}

TEST_CASE("ellipse: footprints are at most as many as there is room for, however it is turned and moved") {
  RandomSource random(402);
  int most = 0;
  for (int i = 0; i < 200000; ++i) {
    const float quarter = 1.5707963f * static_cast<float>(random.integer(0, 3));
    const float angle = i % 2 == 0 ? random.real(0, 6.2831853f) : quarter + random.real(-0.05f, 0.05f);
    const float longer = i % 3 == 0 ? random.real(20, 400) : 32,
                shorter = i % 3 == 0 ? random.real(0, 40) : 2;
    Footprints footprints;
    most = std::max(most, ellipse_footprints(turned(longer, shorter, angle, 16), random.real(90, 92),
                                             random.real(90, 92), footprints));
  }
  CHECK(most > 70);
  CHECK(most <= kMaxEllipseFootprints);
}

TEST_CASE("ellipse: one that is too thin is widened and one that is too wide for its level shrinks") {
  const auto ratio = [](const TexelEllipse& e) { return e.half_width / e.half_height; };
  CHECK(ratio(turned(32, 0, 0, 16)) == Approx(16).epsilon(0.001));
  CHECK(ratio(turned(32, 0, 0, 2)) == Approx(2).epsilon(0.001));
  CHECK(turned(8, 1, 0, 16).half_width == Approx(std::sqrt(65.0)));
  CHECK(turned(8, 1, 0, 16).half_height == Approx(std::sqrt(2.0)));
  CHECK(turned(40, 20, 0, 16).half_width == Approx(std::sqrt(17.0)));
  CHECK(turned(40, 20, 0, 16).half_height == Approx(std::sqrt(5.0)));
}

TEST_CASE("ellipse: changes of any size give an ellipse that holds a texel") {
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const float a : {0.0f, 1e-30f, 1.0f, 1e9f, 1e20f, kMost})
    for (const float b : {0.0f, -1e-20f, 3.0f, -1e12f, -kMost})
      for (const float most : {1.5f, 16.0f}) {
        const TexelEllipse e = texel_ellipse({a, b}, {b, 0.5f * a}, most);
        INFO(a << " " << b);
        CHECK(std::isfinite(e.half_width));
        CHECK(std::isfinite(e.half_height));
        CHECK_FALSE(texels_of(e, 3.25f, 4.5f).empty());
      }
}

TEST_CASE("ellipse: reads are counted by footprint that has a weight, and filter turns by quad") {
  RandomSource random(403);
  DeviceMemory memory;
  const TextureView view = upload(memory, plain_texture(random, false));
  auto plan = std::make_unique<TexturePlan>();
  SamplerState sampler;
  sampler.max_anisotropy = 16;
  for (const auto& [x, y, level] : {std::tuple{12.0f, 1.0f, 0}, {12.0f, 3.0f, 1}, {0.25f, 0.5f, 0}}) {
    TextureRequest request = stretched(x, y);
    request.active = 0x000000f1;
    plan_texture(view, sampler, request, kEllipse, *plan);
    CHECK(plan->finer_level[0] == level);
    CHECK(plan->levels == std::array<std::uint8_t, 4>{1, 0, 0, 0});
    std::uint32_t footprints = 0, turns = 0, most_of_quad = 0;
    for (const std::size_t lane : {0u, 4u, 5u, 6u, 7u}) {
      const auto scale = std::exp2(static_cast<float>(-level));
      Footprints list;
      const auto count = static_cast<std::uint32_t>(
          ellipse_footprints(texel_ellipse({x * scale, 0}, {0, y * scale}, 16),
                             request.u[lane] * 64 * scale - 0.5f, request.v[lane] * 64 * scale - 0.5f, list));
      footprints += count;
      most_of_quad = std::max(most_of_quad, count);
      if (lane == 0 || lane == 7) turns += std::exchange(most_of_quad, 0u);
    }
    CHECK(plan->texels == 4 * footprints);
    CHECK(plan->bilinear_quads == turns);
  }
}

TEST_CASE("ellipse: the weights' sum is divided by, so one colour filters to itself") {
  RandomSource random(404);
  DeviceMemory memory;
  const TextureView view = upload(memory, plain_texture(random, true));
  auto plan = std::make_unique<TexturePlan>();
  SamplerState sampler;
  for (int i = 0; i < 40; ++i) {
    sampler.max_anisotropy = random.real(1.01f, 16.0f);
    const TextureRequest request = stretched(random.real(-40, 40), random.real(-40, 40));
    plan_texture(view, sampler, request, kEllipse, *plan);
    std::array<LaneFloats, 4> rgba;
    filter_texture(*plan, memory, rgba);
    for (std::size_t c = 0; c < 4; ++c)
      for (const float value : rgba[c])
        CHECK(value == Approx(40.0 * static_cast<double>(c + 1) / 255.0).epsilon(1e-5));
  }
}

TEST_CASE("ellipse: coordinates and changes that are not finite give finite colours") {
  RandomSource random(405);
  DeviceMemory memory;
  const TextureView view = upload(memory, plain_texture(random, false));
  auto plan = std::make_unique<TexturePlan>();
  SamplerState sampler;
  sampler.max_anisotropy = 16;
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::array<float, 7> odd{kInf, -kInf, std::numeric_limits<float>::quiet_NaN(), 3e38f, -3e38f,
                                 0,    0.3f};
  for (int i = 0; i < 200; ++i) {
    sampler.wrap_u = static_cast<Wrap>(random.integer(0, static_cast<int>(kLastWrap)));
    sampler.wrap_v = static_cast<Wrap>(random.integer(0, static_cast<int>(kLastWrap)));
    TextureRequest request = stretched(3, 5);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      request.u[lane] = odd[static_cast<std::size_t>(random.integer(0, 6))];
      request.v[lane] = odd[static_cast<std::size_t>(random.integer(0, 6))];
    }
    plan_texture(view, sampler, request, kEllipse, *plan);
    std::array<LaneFloats, 4> rgba;
    filter_texture(*plan, memory, rgba);
    for (const LaneFloats& channel : rgba)
      for (const float value : channel) CHECK((value >= 0 && value <= 1.00001f));
  }
}

TEST_CASE("ellipse: what a lane gets depends on its quad alone") {
  RandomSource random(406);
  DeviceMemory memory;
  const TextureView view = upload(memory, plain_texture(random, false));
  auto plan = std::make_unique<TexturePlan>();
  SamplerState sampler;
  sampler.max_anisotropy = 16;
  TextureRequest request;
  request.op = Op::kTexImplicit;
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    request.u[lane] = random.real(-0.2f, 0.2f);
    request.v[lane] = random.real(-0.03f, 0.03f);
  }
  std::array<LaneFloats, 4> all, one;
  request.active = ~0u;
  plan_texture(view, sampler, request, kEllipse, *plan);
  filter_texture(*plan, memory, all);
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    request.active = 1u << lane;
    plan_texture(view, sampler, request, kEllipse, *plan);
    filter_texture(*plan, memory, one);
    for (std::size_t c = 0; c < 4; ++c) CHECK(one[c][lane] == all[c][lane]);
  }
}
