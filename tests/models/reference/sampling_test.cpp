/// Texture sampling against closed forms.
#include "models/reference/sampling.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace quadrille;
using namespace quadrille::models::reference;

namespace {

/// Level l has texels of red = x, green = y, blue = l * 16, alpha 255.
traces::Image ramp(std::uint32_t width, std::uint32_t height, std::uint32_t levels,
                   traces::Format format = traces::Format::kR8G8B8A8Unorm) {
  traces::Image image{"ramp", format, width, height, levels, {}, nullptr};
  for (std::uint32_t l = 0; l < levels; ++l) {
    for (std::uint32_t y = 0; y < std::max(1u, height >> l); ++y) {
      for (std::uint32_t x = 0; x < std::max(1u, width >> l); ++x) {
        for (const std::uint32_t value : {x, y, l * 16, 255u})
          image.texels.push_back(static_cast<std::byte>(value));
      }
    }
  }
  return image;
}

const traces::Sampler kSmooth{};

}  // namespace

TEST_CASE("sampling: a texel's centre gives the texel, between centres the bilinear filter is linear") {
  const traces::Image image = ramp(8, 4, 1);
  const TextureView view{&image, &kSmooth, nullptr, 0, image.levels};
  CHECK(sample_texture(view, 3.5 / 8, 1.5 / 4, 0, 0)[0] * 255 == Approx(3));
  for (double x = 0.5; x <= 7.5; x += 0.37) {
    const Texel t = sample_texture(view, x / 8, 2.2 / 4, 0, 0);
    CHECK(t[0] * 255 == Approx(x - 0.5));
    CHECK(t[1] * 255 == Approx(1.7));
    CHECK(t[3] == Approx(1));
  }
}

TEST_CASE("sampling: weights are quantised only where a precision is given") {
  const traces::Image image = ramp(8, 4, 1);
  const Precision coarse{8, 2, 8};
  const TextureView view{&image, &kSmooth, &coarse, 0, image.levels};
  for (double x = 0.5; x <= 7.4; x += 0.0625)
    CHECK(sample_texture(view, x / 8, 0.5 / 4, 0, 0)[0] * 255 == Approx(std::floor((x - 0.5) * 4 + 0.5) / 4));
}

TEST_CASE("sampling: wrapping repeats, mirrors and clamps") {
  const traces::Image image = ramp(4, 1, 1);
  const auto texel = [&](traces::Wrap wrap, double x) {
    traces::Sampler sampler;
    sampler.mag = sampler.min = traces::Filter::kNearest, sampler.wrap_u = wrap;
    return std::lround(sample_texture({&image, &sampler, nullptr, 0, image.levels}, x / 4, 0.5, 0, 0)[0] *
                       255);
  };
  const std::array<long, 12> repeat{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
      mirror{3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0}, clamp{0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3};
  for (int i = 0; i < 12; ++i) {
    const double x = i - 4 + 0.3;
    CHECK(texel(traces::Wrap::kRepeat, x) == repeat.at(static_cast<std::size_t>(i)));
    CHECK(texel(traces::Wrap::kMirroredRepeat, x) == mirror.at(static_cast<std::size_t>(i)));
    CHECK(texel(traces::Wrap::kClampToEdge, x) == clamp.at(static_cast<std::size_t>(i)));
  }
}

TEST_CASE("sampling: linear filtering wraps its neighbours") {
  const traces::Image image = ramp(4, 1, 1);
  traces::Sampler sampler;
  // between texels 3 and 0
  CHECK(sample_texture({&image, &sampler, nullptr, 0, image.levels}, 0, 0.5, 0, 0)[0] * 255 == Approx(1.5));
  sampler.wrap_u = traces::Wrap::kClampToEdge;
  CHECK(sample_texture({&image, &sampler, nullptr, 0, image.levels}, 0, 0.5, 0, 0)[0] == 0);
}

TEST_CASE("sampling: level of detail is log2 of the longer footprint in texels") {
  const traces::Image image = ramp(64, 16, 7);
  const TextureView view{&image, &kSmooth, nullptr, 0, image.levels};
  CHECK(base_lod(view, {1.0 / 64, 0}, {0, 1.0 / 16}) == Approx(0).margin(1e-15));
  CHECK(base_lod(view, {4.0 / 64, 0}, {0, 1.0 / 16}) == Approx(2));
  CHECK(base_lod(view, {3.0 / 64, 4.0 / 16}, {0, 1.0 / 16}) == Approx(std::log2(5)));
  CHECK(base_lod(view, {0, 0}, {0, 0}) == -std::numeric_limits<double>::infinity());
}

TEST_CASE("sampling: mip levels blend by the fraction of the level of detail, within bias and clamps") {
  const traces::Image image = ramp(64, 64, 7);
  traces::Sampler sampler;
  const auto level = [&](double lod, double bias = 0) {
    return sample_texture({&image, &sampler, nullptr, 0, image.levels}, 0.3, 0.3, lod, bias)[2] * 255 / 16;
  };
  CHECK(level(2.25) == Approx(2.25));
  CHECK(level(-3) == Approx(0).margin(1e-12));
  CHECK(level(99) == Approx(6));
  CHECK(level(1, 0.5) == Approx(1.5));
  CHECK(level(-std::numeric_limits<double>::infinity()) == Approx(0).margin(1e-12));
  CHECK(level(std::numeric_limits<double>::quiet_NaN()) == Approx(0).margin(1e-12));
  sampler.lod_bias = 0.75f;
  CHECK(level(1, 0.5) == Approx(2.25));
  sampler.lod_bias = 0, sampler.min_lod = 1.5f, sampler.max_lod = 3.25f;
  CHECK(level(-2) == Approx(1.5));
  CHECK(level(5) == Approx(3.25));
}

TEST_CASE("sampling: nearest mip takes the nearer level, the finer one at a half") {
  const traces::Image image = ramp(64, 64, 7);
  traces::Sampler sampler;
  sampler.mip = traces::Filter::kNearest;
  const auto level = [&](double lod) {
    return sample_texture({&image, &sampler, nullptr, 0, image.levels}, 0.3, 0.3, lod, 0)[2] * 255 / 16;
  };
  CHECK(level(1.4) == Approx(1));
  CHECK(level(1.5) == Approx(1));
  CHECK(level(1.6) == Approx(2));
}

TEST_CASE("sampling: the level of detail is quantised where a precision is given") {
  const traces::Image image = ramp(64, 64, 7);
  const Precision coarse{8, 8, 2};
  for (double lod = 0; lod < 5; lod += 0.1) {
    CHECK(sample_texture({&image, &kSmooth, &coarse, 0, image.levels}, 0.3, 0.3, lod, 0)[2] * 255 / 16 ==
          Approx(std::floor(lod * 4 + 0.5) / 4).margin(1e-12));
  }
}

TEST_CASE("sampling: magnification and minification use their own filters") {
  const traces::Image image = ramp(8, 8, 4);
  traces::Sampler sampler;
  sampler.mag = traces::Filter::kNearest;
  const TextureView view{&image, &sampler, nullptr, 0, image.levels};
  CHECK(sample_texture(view, 3.9 / 8, 0.5, 0, 0)[0] * 255 == Approx(3));
  CHECK(sample_texture(view, 3.9 / 8, 0.5, 1e-9, 0)[0] * 255 == Approx(3.4).epsilon(1e-6));
}

TEST_CASE("sampling: sRGB texels are decoded before they are filtered, alpha is linear") {
  traces::Image image{"two", traces::Format::kR8G8B8A8Srgb, 2, 1, 1, {}, nullptr};
  for (const int value : {0, 0, 0, 0, 255, 188, 128, 255})
    image.texels.push_back(static_cast<std::byte>(value));
  const Texel middle = sample_texture({&image, &kSmooth, nullptr, 0, image.levels}, 0.5, 0.5, 0, 0);
  CHECK(middle[0] == Approx(0.5));
  CHECK(middle[1] == Approx(0.5 * std::pow((188.0 / 255 + 0.055) / 1.055, 2.4)));
  CHECK(middle[3] == Approx(0.5));
}

TEST_CASE("sampling: the sRGB curves are each other's inverse and meet the ends") {
  CHECK(linear_to_srgb(0) == 0);
  CHECK(linear_to_srgb(1) == Approx(1));
  CHECK(srgb_to_linear(0.5) == Approx(0.21404114));
  for (double x = 0; x <= 1; x += 1.0 / 512)
    CHECK(linear_to_srgb(srgb_to_linear(x)) == Approx(x).margin(1e-6));
}

TEST_CASE("sampling: coordinates that are not finite or huge stay inside the image") {
  const traces::Image image = ramp(5, 3, 1);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -1e300, 1e18, -1e9}) {
    for (const auto wrap :
         {traces::Wrap::kRepeat, traces::Wrap::kMirroredRepeat, traces::Wrap::kClampToEdge}) {
      traces::Sampler sampler;
      sampler.wrap_u = sampler.wrap_v = wrap;
      const Texel t = sample_texture({&image, &sampler, nullptr, 0, image.levels}, bad, -bad, bad, bad);
      CHECK((t[0] >= 0 && t[0] <= 4.0 / 255));
    }
  }
}
