/// Which samples of a pixel a fragment has, and where it is shaded: centroids, shading by sample, masks of
/// samples, alpha to coverage.
#include "models/base/error.h"
#include "models/reference/compare.h"
#include "models/rop/alpha_coverage.h"
#include "pipeline/render.h"
#include "studies/given_reference.h"
#include "tests/pipeline/coverage_stream.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

using Pixels = std::vector<std::uint32_t>;

Pixels drawn(const traces::CommandStream& stream) { return render_functional_frame(stream, {}).image.color; }
int channel(std::uint32_t pixel, int c) { return static_cast<int>(pixel >> 8 * c & 255u); }
std::ptrdiff_t count(const Pixels& pixels, std::uint32_t value) { return std::ranges::count(pixels, value); }

/// Thin and slanted, so that hardly a pixel's centre lies in it.
const ColoredTriangle kSliver{{{{-0.95f, -0.9f, 0.5f}, {0.93f, 0.85f, 0.5f}, {0.95f, 0.8f, 0.5f}}},
                              {{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}}};

/// Green where the weights of the corners are those of a point of the triangle, else red.
std::string inside_test(const std::string& how) {
  return "layout(location = 0) " + how + R"( in vec4 v_color; layout(location = 0) out vec4 o;
void main() {
  bool outside = any(lessThan(v_color.rgb, vec3(-1e-4))) || any(greaterThan(v_color.rgb, vec3(1.0001)));
  o = outside ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0);
})";
}

std::ptrdiff_t red_pixels(const Pixels& pixels) {
  return std::ranges::count_if(pixels, [](std::uint32_t p) { return channel(p, 0) > 0; });
}

constexpr const char* kWhite = "layout(location = 0) out vec4 o; void main() { o = vec4(1.0); }";

/// Colours of a pixel's channels, of a picture that has one colour.
std::array<int, 4> only_color(const Pixels& pixels) {
  REQUIRE(count(pixels, pixels[0]) == static_cast<std::ptrdiff_t>(pixels.size()));
  return {channel(pixels[0], 0), channel(pixels[0], 1), channel(pixels[0], 2), channel(pixels[0], 3)};
}

void check_reference(const traces::CommandStream& stream) {
  const auto both = studies::render_with_reference(stream, {});
  const auto& ours = both.machine;
  const auto difference = models::reference::compare_images({ours.width, ours.height, ours.color},
                                                            {ours.width, ours.height, both.reference.color});
  CHECK(difference.fraction_within(1) == 1);
}

void check_machines(const traces::CommandStream& stream, std::uint64_t first, std::uint64_t machines) {
  for (std::uint64_t seed = first; seed < first + machines; ++seed) {
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

}  // namespace

TEST_CASE("coverage: a centroid varying is never taken outside of its triangle, another one is") {
  for (const std::uint32_t samples : {2u, 4u, 8u}) {
    const auto picture = [&](const std::string& how) {
      return drawn(coverage_stream({{{kSliver}, inside_test(how)}}, samples, 160, 96));
    };
    CHECK(red_pixels(picture("")) > 20);
    CHECK(red_pixels(picture("noperspective")) > 20);
    for (const char* how : {"centroid", "centroid noperspective", "sample", "noperspective sample"}) {
      const Pixels pixels = picture(how);
      INFO(samples << " samples, " << how);
      CHECK(red_pixels(pixels) == 0);
      CHECK(std::ranges::count_if(pixels, [](std::uint32_t p) { return channel(p, 1) > 0; }) > 40);
    }
  }
}

TEST_CASE("coverage: where all samples are covered, and with one, a centroid is the pixel's centre") {
  const std::string body = " in vec4 v_color; layout(location = 0) out vec4 o; void main() { o = v_color; }";
  for (const std::uint32_t samples : {1u, 4u}) {
    const auto picture = [&](const std::string& how) {
      return drawn(coverage_stream({{{whole_picture()}, "layout(location = 0) " + how + body}}, samples));
    };
    CHECK(picture("centroid") == picture(""));
  }
}

TEST_CASE("coverage: a program by sample is run for each, knows which, and is shaded where it lies") {
  const std::string program = R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() {
  vec2 apart = abs(v_color.rg * vec2(40.0, 24.0) - gl_FragCoord.xy) + abs(fract(gl_FragCoord.xy) - gl_SamplePosition);
  bool one = gl_SampleMaskIn[0] == 1 << gl_SampleID;
  o = vec4(float(gl_SampleID) / 7.0, gl_SamplePosition.x, one && apart.x + apart.y < 0.001 ? 1.0 : 0.0, 1.0);
})";
  for (const std::uint32_t samples : {1u, 2u, 4u, 8u}) {
    const traces::CommandStream stream = coverage_stream({{{whole_picture()}, program}}, samples);
    const RenderedFrame frame = render_functional_frame(stream, {});
    // The mean of 0 to n - 1, in sevenths; the samples of 8 lie a sixteenth's half to the left of the centre.
    const auto color = only_color(frame.image.color);
    CHECK(std::abs(color[0] - std::lround(255.0 * (samples - 1) / 14.0)) <= 1);
    CHECK(std::abs(color[1] - (samples == 8 ? 128 : 128)) <= 1);
    CHECK(color[2] == 255);
    CHECK(frame.figures.frame.fragments_shaded == std::uint64_t{40} * 24 * samples);
  }
}

TEST_CASE("coverage: supersampled is the mean of pictures whose viewports are moved to the samples") {
  const std::string program = R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { o = vec4(fract(v_color.rgb * 7.0), 1.0); })";
  CoverageDraw draw{{whole_picture(0.7f), kSliver}, program};
  draw.triangles.push_back({{{{-0.8f, 0.9f, 0.2f}, {0.1f, -0.7f, 0.2f}, {0.7f, 0.6f, 0.9f}}},
                            {{{1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 0, 1}}}});
  draw.depth = true;
  const std::array<std::array<float, 2>, 4> at{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};
  std::vector<double> mean(std::size_t{40} * 24 * 3);
  for (const auto& [x, y] : at) {
    traces::CommandStream one = coverage_stream({draw}, 1);
    for (traces::Command& command : one.commands)
      if (auto* const viewport = std::get_if<traces::SetViewport>(&command))
        viewport->x -= (x - 8) / 16, viewport->y -= (y - 8) / 16;
    const Pixels pixels = drawn(one);
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += channel(pixels[i / 3], static_cast<int>(i % 3)) / 4.0;
  }
  const auto unlike = [&](bool sample_shading) {
    draw.sample_shading = sample_shading;
    const Pixels pixels = drawn(coverage_stream({draw}, 4));
    std::size_t apart = 0;
    for (std::size_t i = 0; i < mean.size(); ++i)
      if (std::abs(channel(pixels[i / 3], static_cast<int>(i % 3)) - mean[i]) > 1.5) ++apart;
    return apart;
  };
  CHECK(unlike(true) <= 4);  // rounding may move a position of the sub-pixel grid
  CHECK(unlike(false) > 300);
}

TEST_CASE("coverage: masks of samples, of the program and of the pipeline, say which samples are written") {
  const auto program = [](int mask) {
    return "layout(location = 0) out vec4 o; void main() { gl_SampleMask[0] = " + std::to_string(mask) +
           "; o = vec4(1.0); }";
  };
  for (const std::uint32_t samples : {1u, 2u, 4u, 8u}) {
    for (const std::uint32_t mask : {0u, 1u, 2u, 5u, 0x6au, 0xffu}) {
      CoverageDraw of_program{{whole_picture()}, program(static_cast<int>(mask))};
      CoverageDraw of_pipeline{{whole_picture()}, kWhite};
      of_pipeline.sample_mask = mask;
      const unsigned kept = static_cast<unsigned>(std::popcount(mask & ((1u << samples) - 1)));
      for (const bool sample_shading : {false, true}) {
        of_program.sample_shading = of_pipeline.sample_shading = sample_shading;
        for (const CoverageDraw& draw : {of_program, of_pipeline}) {
          const auto color = only_color(drawn(coverage_stream({draw}, samples)));
          INFO(samples << " samples, mask " << mask);
          CHECK(std::abs(color[0] - 255.0 * kept / samples) <= 0.51);
        }
      }
    }
  }
}

TEST_CASE("coverage: depth is written at the samples that a program leaves, unless it forces early tests") {
  const std::string gone =
      "layout(location = 0) out vec4 o; void main() { gl_SampleMask[0] = 2; o = vec4(0.0); }";
  CoverageDraw near{{whole_picture(0.2f)}, gone}, far{{whole_picture(0.8f)}, kWhite};
  near.depth = far.depth = true;
  // Behind a drawing that left one sample of four: three are white.
  const traces::CommandStream late = coverage_stream({near, far}, 4);
  CHECK(only_color(drawn(late))[0] == 191);
  check_machines(late, 0, 3);
  // With early tests depth is written at all four, before it is known which ones stay.
  near.fragment = "layout(early_fragment_tests) in;" + gone;
  const traces::CommandStream early = coverage_stream({near, far}, 4);
  CHECK(only_color(drawn(early))[0] == 0);
  check_machines(early, 0, 3);
  // Alpha to coverage is after shading as well, and with one sample too.
  near.fragment = "layout(location = 0) out vec4 o; void main() { o = vec4(0.0, 0.0, 0.0, 0.4); }";
  near.alpha_to_coverage = true;
  CHECK(only_color(drawn(coverage_stream({near, far}, 4)))[0] == 128);
  CHECK(only_color(drawn(coverage_stream({near, far}, 1)))[0] == 255);
}

TEST_CASE("coverage: more alpha keeps more samples, from none to all") {
  for (const int samples : {1, 2, 4, 8}) {
    CHECK(models::alpha_coverage(0, samples) == 0);
    CHECK(models::alpha_coverage(-1, samples) == 0);
    CHECK(models::alpha_coverage(std::nanf(""), samples) == 0);
    CHECK(models::alpha_coverage(1, samples) == (1u << samples) - 1);
    std::uint32_t before = 0;
    for (int step = 0; step <= 1000; ++step) {
      const std::uint32_t kept = models::alpha_coverage(static_cast<float>(step) / 1000.0f, samples);
      CHECK((kept & before) == before);
      CHECK(std::has_single_bit(kept + 1));  // the first ones
      before = kept;
    }
  }
  // In a picture: as many shades from left to right as there are samples, and black.
  CoverageDraw draw{{whole_picture()},
                    "layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;"
                    "void main() { o = vec4(1.0, 1.0, 1.0, v_color.r - 0.05); }"};
  draw.alpha_to_coverage = true;
  const Pixels pixels = drawn(coverage_stream({draw}, 4));
  int before = 0, shades = 1;
  for (std::size_t x = 0; x < 40; ++x) {
    const int red = channel(pixels[x], 0);
    CHECK(red >= before);
    shades += red != before ? 1 : 0;
    before = red;
  }
  CHECK(shades == 5);
}

TEST_CASE("coverage: a program by sample that writes memory is invoked once for each covered sample") {
  for (const std::uint32_t samples : {1u, 4u}) {
    StorageShape shape;
    shape.depth_test = false;
    shape.fragment_declarations = "layout(std430, set = 0, binding = 0) buffer B { uint count, last[]; } b;";
    shape.fragment_body = R"(atomicAdd(b.count, 1u);
b.last[uint(gl_FragCoord.y) * 88u + uint(gl_FragCoord.x)] = uint(gl_SampleID) + 1u;)";
    traces::CommandStream stream = storage_stream(3, shape);
    traces::use_samples(stream, samples);
    const RenderedFrame frame = render_functional_frame(stream, {});
    std::vector<std::uint32_t> words(frame.buffers.at(0).data.size() / 4);
    std::memcpy(words.data(), frame.buffers[0].data.data(), 4 * words.size());
    CHECK(words[0] == frame.figures.frame.fragments_shaded);
    // The last one in order stays: of a pixel that is covered wholly the last sample.
    CHECK(static_cast<std::uint32_t>(std::ranges::count(words, samples)) > 500);
    check_machines(stream, 0, 2);
  }
}

TEST_CASE("coverage: random machines draw random streams that ask for samples as the functional run does") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    traces::CommandStream stream = random_stream(seed + 40);
    add_sample_states(stream, seed);
    traces::use_samples(stream, 1u << seed % 4);
    INFO("stream " << seed);
    check_machines(stream, 2 * seed, 2);
  }
}

TEST_CASE("coverage: the reference follows") {
  const std::string centroid =
      "layout(location = 0) centroid in vec4 v_color; layout(location = 0) out vec4 o; void main() { o = "
      "v_color; }";
  const std::string by_sample =
      R"(layout(location = 0) sample in vec4 v_color; layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.rg, gl_SamplePosition.y, float(gl_SampleID + 1) / 8.0); })";
  const std::string mask = R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { gl_SampleMask[0] = gl_SampleMaskIn[0] & 0x35; o = vec4(v_color.rgb, float(gl_SampleMaskIn[0]) / 255.0); })";
  const std::string alpha = R"(layout(location = 0) in vec4 v_color; layout(location = 0) out vec4 o;
void main() { o = vec4(v_color.rgb, v_color.r * 0.37 + 0.31); })";
  for (const std::uint32_t samples : {1u, 2u, 4u, 8u}) {
    for (const std::string& program : {centroid, by_sample, mask, alpha}) {
      for (const int state : {0, 1, 2, 3}) {
        CoverageDraw one{{kSliver}, program}, whole{{whole_picture(0.7f)}, centroid};
        one.depth = whole.depth = true;
        one.triangles.push_back({{{{-0.8f, 0.9f, 0.2f}, {0.1f, -0.7f, 0.3f}, {0.7f, 0.6f, 0.9f}}},
                                 {{{1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 0, 1}}}});
        one.sample_shading = state == 1;
        one.alpha_to_coverage = state == 2;
        if (state == 3) one.sample_mask = 0xd6;
        INFO(samples << " samples, state " << state << ": " << program);
        check_reference(coverage_stream({one, whole}, samples));
      }
    }
  }
}
