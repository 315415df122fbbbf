/// Whole frames against closed forms: assembly, culling, interpolation, mip selection, depth, discard, state.
#include "models/base/error.h"
#include "tests/models/reference/test_frame.h"

#include <catch2/catch.hpp>

#include <set>

using namespace quadrille;
using namespace quadrille::models::reference;
using namespace quadrille::models::reference::test;

TEST_CASE("render: a full-screen quad covers every pixel once, half by each triangle") {
  TestFrame frame(16, 16);
  frame.pipeline();
  frame.draw(full_screen({1, 0.5f, 0, 1}));
  const Result r = frame.render();
  CHECK(std::all_of(r.color.begin(), r.color.end(), [](std::uint32_t c) { return c == 0xff0080ffu; }));
  CHECK(std::count(r.triangle_id.begin(), r.triangle_id.end(), 0u) +
            std::count(r.triangle_id.begin(), r.triangle_id.end(), 1u) ==
        256);
  CHECK(r.depth[37] == 1);  // the depth test is off
}

TEST_CASE("render: untouched pixels keep the clear values, encoded as the target asks") {
  TestFrame frame(4, 4, traces::Format::kR8G8B8A8Srgb, {0.5f, 0, 1, 0.5f});
  const Result r = frame.render();
  CHECK(r.color[5] == 0x80ff00bcu);
  CHECK(r.color_linear[4 * 5] == 0.5);
  CHECK(r.triangle_id[5] == kNoTriangle);
}

TEST_CASE("render: strips and fans have Vulkan's triangles, order and provoking vertex") {
  const char* flat_vertex =
      "#version 450\nlayout(location = 0) in vec4 position; layout(location = 1) in vec4 value; "
      "layout(location = 0) flat out vec4 v;\n"
      "void main() { gl_Position = position; v = value; }\n";
  const char* flat_fragment =
      "#version 450\nlayout(location = 0) flat in vec4 v; layout(location = 0) out vec4 o;\nvoid main() { o "
      "= v / 255.0; }\n";
  const auto value = [](int i) { return std::array<float, 4>{static_cast<float>(i), 0, 0, 0}; };
  TestFrame strip(16, 16);
  strip.pipeline(flat_fragment, flat_vertex).topology = traces::Topology::kTriangleStrip;
  strip.stream.pipelines.back().cull = traces::CullMode::kBack;  // all triangles of a strip face the same way
  strip.draw({at(0, 16, value(10)), at(0, 0, value(11)), at(8, 16, value(12)), at(8, 0, value(13)),
              at(16, 16, value(14))});
  strip.stream.pipelines.back().front = traces::FrontFace::kClockwise;
  const Result s = strip.render();
  CHECK(channel(s.color[14 * 16 + 1], 0) == 10);  // triangle 0: vertices 0 1 2
  CHECK(channel(s.color[1 * 16 + 6], 0) == 11);   // triangle 1: vertices 1 3 2
  CHECK(channel(s.color[14 * 16 + 9], 0) == 12);  // triangle 2: vertices 2 3 4
  CHECK(s.triangle_id[1 * 16 + 6] == 1);
  TestFrame fan(16, 16);
  fan.pipeline(flat_fragment, flat_vertex).topology = traces::Topology::kTriangleFan;
  fan.draw({at(0, 0, value(20)), at(16, 0, value(21)), at(16, 16, value(22)), at(0, 16, value(23))});
  const Result f = fan.render();
  CHECK(channel(f.color[1 * 16 + 12], 0) == 21);  // triangle 0: vertices 1 2 0
  CHECK(channel(f.color[12 * 16 + 1], 0) == 22);  // triangle 1: vertices 2 3 0
  CHECK(count_covered(f) == 256);
}

TEST_CASE("render: facing follows the signed area with y down, culling removes the face it names") {
  // Clockwise on the screen.
  const std::vector<Vertex> clockwise{at(2, 2), at(14, 2), at(2, 14)};
  const char* facing =
      "#version 450\nlayout(location = 0) out vec4 o;\nvoid main() { o = vec4(gl_FrontFacing ? 1.0 : 0.0); "
      "}\n";
  for (const auto front : {traces::FrontFace::kClockwise, traces::FrontFace::kCounterClockwise}) {
    for (const auto cull : {traces::CullMode::kNone, traces::CullMode::kFront, traces::CullMode::kBack}) {
      TestFrame frame(16, 16);
      frame.pipeline(facing);
      frame.stream.pipelines.back().front = front, frame.stream.pipelines.back().cull = cull;
      frame.draw(clockwise);
      const Result r = frame.render();
      const bool is_front = front == traces::FrontFace::kClockwise;
      const bool culled =
          (cull == traces::CullMode::kFront && is_front) || (cull == traces::CullMode::kBack && !is_front);
      CHECK((count_covered(r) == 0) == culled);
      if (!culled) CHECK(channel(r.color[4 * 16 + 4], 0) == (is_front ? 255 : 0));
    }
  }
}

TEST_CASE("render: attributes are perspective-correct") {
  // A plane that recedes: at ndc y, 1/w is linear from 1 (bottom) to 1/4 (top), and v is linear in clip
  // space.
  TestFrame frame(16, 64);
  frame.pipeline();
  const auto vertex = [](float x, float y, float w, float v) {
    return Vertex{{x * w, y * w, 0.5f * w, w}, {v, 0, 0, 1}};
  };
  frame.draw({vertex(-1, 1, 1, 0), vertex(1, 1, 1, 0), vertex(1, -1, 4, 1), vertex(-1, 1, 1, 0),
              vertex(1, -1, 4, 1), vertex(-1, -1, 4, 1)});
  const Result r = frame.render();
  for (std::size_t y = 0; y < 64; ++y) {
    const double t = 1 - (static_cast<double>(y) + 0.5) / 64;  // 0 at the bottom
    const double expected = t * 0.25 / ((1 - t) + t * 0.25);
    CHECK(r.color_linear[4 * (y * 16 + 5)] == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("render: noperspective and flat inputs, FragCoord and clipped triangles") {
  const char* vertex =
      "#version 450\nlayout(location = 0) in vec4 position; layout(location = 1) in vec4 value; "
      "layout(location = 0) noperspective out "
      "float v;\n"
      "layout(location = 1) flat out int f;\nvoid main() { gl_Position = position; v = value.x; f = "
      "int(value.y); }\n";
  const char* fragment =
      "#version 450\nlayout(location = 0) noperspective in float v; layout(location = 1) flat in int f; "
      "layout(location = 0) out vec4 o;\n"
      "void main() { o = vec4(v, float(f) / 10.0, gl_FragCoord.x / 32.0, gl_FragCoord.w); }\n";
  TestFrame frame(16, 64);
  frame.pipeline(fragment, vertex);
  const auto v = [](float x, float y, float w, float z, float value) {
    return Vertex{{x * w, y * w, z * w, w}, {value, value * 2 + 3, 0, 0}};
  };
  // The far vertices lie beyond the far plane (z > w), so the triangles are cut; what is left is as if they
  // were not.
  frame.draw({v(-1, 1, 1, 0.25f, 0), v(1, 1, 1, 0.25f, 0), v(1, -1, 4, 1.25f, 1)});
  const Result r = frame.render();
  for (std::size_t y = 50; y < 64; ++y) {
    const double t = 1 - (static_cast<double>(y) + 0.5) / 64;
    const std::size_t pixel = y * 16 + 15;
    CHECK(r.color_linear[4 * pixel] == Approx(t).epsilon(1e-6));
    CHECK(r.color_linear[4 * pixel + 1] == Approx(0.3).epsilon(1e-6));
    CHECK(r.color_linear[4 * pixel + 2] == Approx(15.5 / 32));
    CHECK(r.color_linear[4 * pixel + 3] == Approx((1 - t) + t * 0.25));
  }
  CHECK(r.triangle_id[2 * 16 + 15] == kNoTriangle);  // beyond the far plane
}

TEST_CASE("render: clipping at the near plane leaves colours as they were and cuts where z is zero") {
  TestFrame frame(16, 16);
  frame.pipeline();
  // z runs from -1 at the left to 1 at the right: the left half is clipped.
  const auto v = [](float x, float y) { return Vertex{{x, y, x, 1}, {x * 0.5f + 0.5f, 0, 0, 1}}; };
  frame.draw({v(-1, -1), v(1, -1), v(1, 1), v(-1, -1), v(1, 1), v(-1, 1)});
  const Result r = frame.render();
  for (std::size_t p = 0; p < 256; ++p) {
    CHECK((r.triangle_id[p] != kNoTriangle) == (p % 16 >= 8));
    if (p % 16 >= 8) CHECK(r.color_linear[4 * p] == Approx((static_cast<double>(p % 16) + 0.5) / 16));
  }
}

TEST_CASE("render: depth clamp keeps what the near plane would cut, at the clamped depth") {
  TestFrame frame(16, 16);
  frame.pipeline().depth_clamp = true;
  frame.stream.pipelines.back().depth = {true, true, traces::CompareOp::kLess};
  const auto v = [](float x, float y) { return Vertex{{x, y, x, 1}, {1, 1, 1, 1}}; };
  frame.draw({v(-1, -1), v(1, -1), v(1, 1), v(-1, -1), v(1, 1), v(-1, 1)});
  const Result r = frame.render();
  CHECK(count_covered(r) == 256);
  CHECK(r.depth[3] == 0);
  CHECK(r.depth[12] == Approx(12.5 / 8 - 1));
}

TEST_CASE("render: the depth test orders triangles, writes only if told, and reports how near it was") {
  TestFrame frame(8, 8);
  frame.pipeline().depth = {true, true, traces::CompareOp::kLess};
  frame.draw(full_screen({1, 0, 0, 1}, 0.5f));
  frame.draw(full_screen({0, 1, 0, 1}, 0.75f));            // behind
  frame.draw(full_screen({0, 0, 1, 1}, 0.5f - 0x1p-24f));  // two units (of the last place of 0.5) in front
  const Result r = frame.render();
  CHECK(r.color[9] == 0xffff0000u);
  CHECK(r.triangle_id[9] >> 32 == 2);
  CHECK(r.depth[9] == Approx(0.5));
  CHECK(r.depth_margin[9] == Approx(1).epsilon(1e-3));
  frame.stream.pipelines[0].depth.write = false;
  const Result unwritten = frame.render();
  CHECK(unwritten.depth[9] == 1);
  CHECK(unwritten.color[9] == 0xffff0000u);
}

TEST_CASE("render: a shader's own depth is tested in place of the triangle's") {
  TestFrame frame(8, 8);
  frame
      .pipeline(
          "#version 450\nlayout(location = 0) in vec4 v; layout(location = 0) out vec4 o;\nvoid main() { o = "
          "v; gl_FragDepth = "
          "gl_FragCoord.x / 8.0; }\n")
      .depth = {true, true, traces::CompareOp::kLess};
  frame.draw(full_screen({1, 0, 0, 1}, 0.0f));
  frame.pipeline().depth = {true, false, traces::CompareOp::kLess};
  frame.draw(full_screen({0, 1, 0, 1}, 0.5f));
  const Result r = frame.render();
  for (std::size_t p = 0; p < 64; ++p) CHECK(r.color[p] == (p % 8 < 4 ? 0xff0000ffu : 0xff00ff00u));
}

TEST_CASE("render: discard writes neither colour nor depth, and reports its margin") {
  TestFrame frame(8, 8);
  frame
      .pipeline(
          "#version 450\nlayout(location = 0) out vec4 o;\nvoid main() { float a = gl_FragCoord.x / 8.0; if "
          "(a < 0.5) discard; o = "
          "vec4(1); }\n")
      .depth = {true, true, traces::CompareOp::kLess};
  frame.draw(full_screen({1, 1, 1, 1}));
  const Result r = frame.render();
  for (std::size_t p = 0; p < 64; ++p) {
    CHECK(r.color[p] == (p % 8 < 4 ? 0u : 0xffffffffu));
    CHECK(r.depth[p] == (p % 8 < 4 ? 1.0 : 0.5));
    CHECK(r.alpha_margin[p] == Approx(std::abs((static_cast<double>(p % 8) + 0.5) / 8 - 0.5)));
  }
}

TEST_CASE("render: blending uses what is stored, so two draws round twice") {
  TestFrame frame(4, 4);
  traces::BlendState& state = frame.pipeline().blend[0];
  state.enable = true, state.src_color = traces::BlendFactor::kOne,
  state.dst_color = traces::BlendFactor::kOne;
  frame.draw(full_screen({0.4f / 255, 0, 0, 0}));
  frame.draw(full_screen({0.4f / 255, 0, 0, 0}));
  CHECK(frame.render().color[0] == 0);  // 0.4 rounds to 0 each time
}

TEST_CASE("render: a textured plane picks the mip level of its scale") {
  const char* fragment =
      "#version 450\nlayout(location = 0) in vec4 v; layout(set = 0, binding = 1) uniform sampler2D t; "
      "layout(location = 0) out vec4 o;\n"
      "void main() { o = texture(t, v.xy); }\n";
  for (const double scale : {1.0, 2.0, 3.0, 4.0, 6.5}) {  // texels a pixel
    TestFrame frame(16, 16);
    frame.pipeline(fragment);
    traces::Image image{"levels", traces::Format::kR8G8B8A8Unorm, 128, 128, 8, {}, nullptr};
    for (std::uint32_t l = 0; l < 8; ++l)
      image.texels.insert(image.texels.end(), std::size_t{4} * (128u >> l) * (128u >> l),
                          static_cast<std::byte>(l * 30));
    frame.stream.images.push_back(image);
    frame.stream.samplers.emplace_back();
    const auto at = static_cast<traces::Index>(frame.stream.images.size() - 1);
    frame.stream.descriptor_sets.push_back({{}, {{1, at, 0}}});
    frame.stream.commands.push_back(traces::BindDescriptorSet{0, 0});
    const auto uv = [&](float x, float y) {
      const auto s = static_cast<float>(scale * 16 / 128);
      return Vertex{{x * 2 - 1, y * 2 - 1, 0.5f, 1}, {x * s, y * s, 0, 0}};
    };
    frame.draw({uv(0, 0), uv(1, 0), uv(1, 1), uv(0, 0), uv(1, 1), uv(0, 1)});
    CHECK(frame.render().color_linear[4 * 100] * 255 / 30 == Approx(std::log2(scale)).margin(1e-6));
    Options given{Mode::kGiven, {8, 8, 1}, {}, {}, 1};
    for (std::uint32_t p = 0; p < 2; ++p) {
      GivenTriangle t;
      t.primitive = p, t.x = {0, 16 * 256, p == 0 ? 16 * 256 : 0}, t.y = {0, p == 0 ? 0 : 16 * 256, 16 * 256};
      t.z = {0.5, 0.5, 0.5}, t.inv_w = {1, 1, 1}, t.barycentric = {{{0, 0}, {1, 0}, {0, 1}}};
      given.given.push_back(t);
    }
    CHECK(frame.render(given).color_linear[4 * 100] * 255 / 30 ==
          Approx(std::floor(std::log2(scale) * 2 + 0.5) / 2).margin(1e-6));
  }
}
