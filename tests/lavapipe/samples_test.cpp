/// Several samples a pixel: the machine's resolved picture against lavapipe's, pixel by pixel.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <memory>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/coverage_stream.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/storage_stream.h"

namespace quadrille::lavapipe {
namespace {

/// Pixels of which a channel is more than `limit` apart.
std::size_t unlike(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b, int limit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    int most = 0;
    for (unsigned c = 0; c < 4; ++c)
      most = std::max(
          most, std::abs(static_cast<int>(a[i] >> 8 * c & 255u) - static_cast<int>(b[i] >> 8 * c & 255u)));
    count += most > limit ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("samples: overlapping triangles are lavapipe's at one and at four samples a pixel") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  for (const std::uint32_t samples : {1u, 4u}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      traces::CommandStream stream = pipeline::test::storage_stream(seed, {});
      traces::use_samples(stream, samples);
      const pipeline::RenderedFrame ours = pipeline::render_functional_frame(stream, {});
      const Rendered theirs = vulkan->render(stream);
      INFO(samples << " samples, stream " << seed);
      // Where two triangles are as deep at a sample, the two may differ.
      CHECK(unlike(ours.image.color, theirs.color, 2) <= 2 * samples);
    }
  }
}

namespace {

/// A slanted sliver and a triangle over it, in colours. Without depth test: lavapipe takes a centroid at a
/// sample that passes it.
traces::CommandStream two_triangles(const std::string& fragment, std::uint32_t samples,
                                    std::uint32_t sample_mask = ~0u, bool sample_shading = false,
                                    bool alpha_to_coverage = false) {
  pipeline::test::CoverageDraw draw{{{{{{-0.95f, -0.9f, 0.6f}, {0.93f, 0.85f, 0.6f}, {0.95f, 0.8f, 0.6f}}},
                                      {{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}}},
                                     {{{{-0.8f, 0.9f, 0.2f}, {0.1f, -0.7f, 0.3f}, {0.7f, 0.6f, 0.9f}}},
                                      {{{1, 0, 1, 0.9f}, {0, 1, 1, 0.1f}, {1, 1, 0, 0.6f}}}}},
                                    fragment};
  draw.sample_mask = sample_mask;
  draw.sample_shading = sample_shading;
  draw.alpha_to_coverage = alpha_to_coverage;
  return pipeline::test::coverage_stream({draw}, samples, 80, 56);
}

}  // namespace

/// Not both of alpha to coverage and shading by sample: in lavapipe the alpha of a pixel's one sample takes
/// away the others too.
TEST_CASE("samples: centroids, shading by sample, masks and alpha to coverage are lavapipe's") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  const auto fragment = [](const std::string& how, const std::string& body) {
    return "layout(location = 0) " + how +
           " in vec4 v_color; layout(location = 0) out vec4 o; void main() { " + body + " }";
  };
  const std::string plain = fragment("", "o = v_color;");
  const std::string place = fragment(
      "", "o = vec4(gl_SamplePosition, float(gl_SampleID) / 7.0, float(gl_SampleMaskIn[0]) / 255.0);");
  const struct {
    const char* what;
    traces::CommandStream one, four;
  } cases[] = {
      {"centroid", two_triangles(fragment("centroid", "o = v_color;"), 1),
       two_triangles(fragment("centroid", "o = v_color;"), 4)},
      {"centroid noperspective", two_triangles(fragment("centroid noperspective", "o = v_color;"), 1),
       two_triangles(fragment("centroid noperspective", "o = v_color;"), 4)},
      {"sample", two_triangles(fragment("sample", "o = v_color;"), 1),
       two_triangles(fragment("sample", "o = v_color;"), 4)},
      {"sample shading", two_triangles(plain, 1, ~0u, true), two_triangles(plain, 4, ~0u, true)},
      {"place", two_triangles(place, 1), two_triangles(place, 4)},
      {"covered", two_triangles(fragment("", "o = vec4(float(gl_SampleMaskIn[0]) / 15.0);"), 1),
       two_triangles(fragment("", "o = vec4(float(gl_SampleMaskIn[0]) / 15.0);"), 4)},
      {"place of a fragment",
       two_triangles(fragment("", "o = vec4(fract(gl_FragCoord.xy), 0, 1);"), 1, ~0u, true),
       two_triangles(fragment("", "o = vec4(fract(gl_FragCoord.xy), 0, 1);"), 4, ~0u, true)},
      {"mask of the program",
       two_triangles(fragment("", "gl_SampleMask[0] = int(v_color.g * 15.0); o = v_color;"), 1),
       two_triangles(fragment("", "gl_SampleMask[0] = int(v_color.g * 15.0); o = v_color;"), 4)},
      // Of one sample lavapipe looks at no mask of the pipeline.
      {"mask of the pipeline", two_triangles(plain, 1, 0x7), two_triangles(plain, 4, 0x6)},
      {"mask of the pipeline, centroid", two_triangles(fragment("centroid", "o = v_color;"), 1, 0xd),
       two_triangles(fragment("centroid", "o = v_color;"), 4, 0xd)},
      {"alpha to coverage", two_triangles(plain, 1, ~0u, false, true),
       two_triangles(plain, 4, ~0u, false, true)}};
  for (const auto& c : cases) {
    for (const traces::CommandStream* stream : {&c.one, &c.four}) {
      const pipeline::RenderedFrame ours = pipeline::render_functional_frame(*stream, {});
      const Rendered theirs = vulkan->render(*stream);
      INFO(c.what << ", " << (stream == &c.one ? 1 : 4));
      CHECK(unlike(ours.image.color, theirs.color, 1) == 0);
    }
  }
}

}  // namespace quadrille::lavapipe
