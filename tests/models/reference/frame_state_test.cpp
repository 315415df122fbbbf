/// Whole frames: given triangles, vertex input, uniforms, viewport, threads, and hostile input.
#include "models/base/error.h"
#include "tests/models/reference/test_frame.h"

#include <catch2/catch.hpp>

#include <set>

using namespace quadrille;
using namespace quadrille::models::reference;
using namespace quadrille::models::reference::test;

TEST_CASE("render: given triangles decide coverage, depth and weights, attributes come from the vertices") {
  TestFrame frame(16, 16);
  frame.pipeline().depth = {true, true, traces::CompareOp::kLess};
  frame.draw({at(0, 0, {0, 0, 0, 1}), at(16, 0, {1, 0, 0, 1}), at(0, 16, {0, 1, 0, 1})});
  GivenTriangle t;
  t.x = {0, 8 * 256, 0}, t.y = {0, 0, 8 * 256};  // a quarter of the triangle drawn
  t.z = {0.25, 0.25, 0.25}, t.inv_w = {1, 1, 1};
  t.barycentric = {{{0, 0}, {0.5, 0}, {0, 0.5}}};
  const Result r = frame.render({Mode::kGiven, {}, {t}, {}, 1});
  const Result whole = frame.render();
  CHECK(count_covered(r) == 28);
  for (std::size_t p = 0; p < 256; ++p) {
    if (r.triangle_id[p] == kNoTriangle) continue;
    CHECK(r.color_linear[4 * p] == Approx(whole.color_linear[4 * p]));
    CHECK(r.depth[p] == 0.25);
  }
  t.z = {0.1, 0.1, 0.1};
  CHECK(frame.render({Mode::kGiven, {}, {t}, {}, 1}).depth[17] == static_cast<double>(0.1f));
}

TEST_CASE("render: given triangles that the stream does not have are the user's mistake") {
  TestFrame frame(16, 16);
  frame.pipeline();
  frame.draw({at(0, 0), at(16, 0), at(0, 16)});
  GivenTriangle t;
  t.primitive = 1;
  CHECK_THROWS_WITH(frame.render({Mode::kGiven, {}, {t}, {}, 1}), Catch::Contains("primitive"));
  t.primitive = 0, t.draw = 1;
  CHECK_THROWS_WITH(frame.render({Mode::kGiven, {}, {t}, {}, 1}), Catch::Contains("draw 1"));
  CHECK_THROWS_WITH(frame.render({Mode::kGiven, {}, {t, GivenTriangle{}}, {}, 1}), Catch::Contains("order"));
  CHECK_THROWS_WITH(frame.render({Mode::kGiven, {0, 8, 8}, {}, {}, 1}), Catch::Contains("subpixel_bits"));
}

TEST_CASE("render: every vertex format is read as the specification says") {
  using traces::Format;
  struct Case {
    Format format;
    std::vector<std::uint8_t> bytes;
    std::array<double, 4> value;
  };
  const std::vector<Case> cases{
      {Format::kR32Float, {0, 0, 0, 0x3f}, {0.5, 0, 0, 1}},
      {Format::kR32G32Float, {0, 0, 0, 0x3f, 0, 0, 0x80, 0x3e}, {0.5, 0.25, 0, 1}},
      {Format::kR8G8Unorm, {255, 51}, {1, 0.2, 0, 1}},
      {Format::kR8G8B8A8UnormVertex, {0, 51, 102, 153}, {0, 0.2, 0.4, 0.6}},
      {Format::kR16G16Unorm, {0xff, 0xff, 0, 0}, {1, 0, 0, 1}},
      {Format::kR16G16B16A16Unorm, {0x33, 0x33, 0xff, 0xff, 0, 0, 0x66, 0x66}, {0.2, 1, 0, 0.4}},
      {Format::kR8G8B8A8Snorm, {127, 0, 0x81, 0x80}, {1, 0, 0, 0}},
      {Format::kR16G16B16A16Snorm, {0xff, 0x7f, 0, 0, 0, 0, 0xff, 0x7f}, {1, 0, 0, 1}}};
  for (const Case& c : cases) {
    TestFrame frame(2, 2);
    frame.pipeline().bindings.push_back({1, 0, true});
    frame.stream.pipelines.back().attributes[1] = {1, 1, c.format, 0};
    frame.stream.commands.push_back(traces::BindVertexBuffer{1, frame.buffer(bytes_of(c.bytes)), 0});
    frame.draw(full_screen({}));
    const Result r = frame.render();
    for (std::size_t i = 0; i < 4; ++i) CHECK(r.color_linear[i] == Approx(c.value.at(i)).margin(1e-12));
  }
}

TEST_CASE("render: indices of every size, vertex offset, first index, instances and the built-in indices") {
  const char* vertex =
      "#version 450\nlayout(location = 0) in vec4 position; layout(location = 1) in vec4 value; "
      "layout(location = 0) out vec4 v;\n"
      "void main() { gl_Position = position + vec4(float(gl_InstanceIndex - 5), 0, 0, 0); v = "
      "vec4(float(gl_VertexIndex), "
      "float(gl_InstanceIndex), value.x, 0) / 255.0; }\n";
  std::vector<Vertex> vertices(3);
  for (const Vertex& v : {at(0, 0), at(8, 0), at(8, 16), at(0, 16)}) vertices.push_back(v);
  for (const auto type :
       {traces::IndexType::kUint8, traces::IndexType::kUint16, traces::IndexType::kUint32}) {
    TestFrame frame(16, 16);
    frame.pipeline(kShowValue, vertex);
    const std::vector<std::uint32_t> indices{9, 1, 2, 3, 1, 3, 4};
    std::vector<std::uint8_t> narrow(indices.begin(), indices.end());
    std::vector<std::uint16_t> middle(indices.begin(), indices.end());
    const traces::Index buffer = frame.buffer(type == traces::IndexType::kUint8    ? bytes_of(narrow)
                                              : type == traces::IndexType::kUint16 ? bytes_of(middle)
                                                                                   : bytes_of(indices));
    frame.stream.commands.push_back(traces::BindVertexBuffer{0, frame.buffer(bytes_of(vertices)), 0});
    frame.stream.commands.push_back(traces::BindIndexBuffer{buffer, 0, type});
    frame.stream.commands.push_back(traces::Draw{true, 6, 1, 2, 2, 5, ""});
    const Result r = frame.render();
    CHECK(count_covered(r) == 256);
    CHECK(channel(r.color[0], 0) == 3);
    CHECK(channel(r.color[0], 1) == 5);
    CHECK(channel(r.color[15], 0) == 4);
    CHECK(channel(r.color[15], 1) == 6);
    CHECK(channel(r.color[15], 2) == 1);
  }
}

TEST_CASE("render: uniform blocks by std140, row-major members, arrays and push constants") {
  const char* fragment =
      "#version 450\nlayout(set = 1, binding = 2) uniform B { float x; vec3 y; mat2 m; layout(row_major) "
      "mat3x2 r; float list[2]; int k; } "
      "b;\n"
      "layout(push_constant) uniform P { layout(offset = 8) vec2 p; };\nlayout(location = 0) out vec4 o;\n"
      "void main() { o = vec4(b.x + b.y.z, b.m[1][0] * 10.0 + b.r[2][1], b.list[b.k], p.y) / 255.0; }\n";
  TestFrame frame(2, 2);
  frame.pipeline(fragment);
  std::vector<float> block(64);
  block[4] = 1;                             // x; the binding starts 16 bytes into the buffer
  block[4 + 6] = 2;                         // y.z at 16 + 8
  block[4 + 8 + 4] = 3;                     // m: columns 16 bytes apart, at 32
  block[4 + 16 + 4 + 2] = 4;                // r: rows 16 bytes apart, at 64; row 1, column 2
  block[4 + 24 + 4] = 50;                   // list[1]: elements 16 bytes apart, at 96
  block[4 + 32] = std::bit_cast<float>(1);  // k at 128
  frame.stream.descriptor_sets.push_back({{{2, frame.buffer(bytes_of(block)), 16, 144}}, {}});
  frame.stream.commands.push_back(traces::BindDescriptorSet{1, 0});
  frame.stream.commands.push_back(traces::PushConstants{12, bytes_of(std::vector<float>{77})});
  frame.draw(full_screen({}));
  CHECK(frame.render().color[0] == (77u << 24 | 50u << 16 | 34u << 8 | 3u));
  frame.stream.commands.erase(frame.stream.commands.begin() + 4);  // the descriptor set's binding
  CHECK_THROWS_WITH(frame.render(), Catch::Contains("set 1"));
}

TEST_CASE("render: viewport, scissor and depth range place the picture") {
  TestFrame frame(16, 16);
  frame.pipeline().depth = {true, true, traces::CompareOp::kLess};
  frame.stream.commands.push_back(traces::SetViewport{4, 2, 8, 8, 0.5f, 0.75f});
  frame.stream.commands.push_back(traces::SetScissor{6, -1, 100, 8});
  frame.draw(full_screen({1, 1, 1, 1}, 0.5f));
  const Result r = frame.render();
  for (std::size_t p = 0; p < 256; ++p) {
    const std::size_t x = p % 16, y = p / 16;
    CHECK((r.triangle_id[p] != kNoTriangle) == (x >= 6 && x < 12 && y >= 2 && y < 7));
    if (r.triangle_id[p] != kNoTriangle) CHECK(r.depth[p] == Approx(0.625));
  }
}

TEST_CASE("render: threads and regions do not change a pixel") {
  TestFrame frame(64, 64);
  frame.pipeline(
      "#version 450\nlayout(location = 0) in vec4 v; layout(location = 0) out vec4 o;\nvoid main() { o = v + "
      "vec4(abs(dFdx(v.x)) * 40.0); "
      "if (v.y > 0.8) discard; }\n");
  frame.stream.pipelines.back().depth = {true, true, traces::CompareOp::kLess};
  std::vector<Vertex> soup;
  for (int i = 0; i < 90; ++i) {
    const auto wave = [i](double k) { return static_cast<float>(std::sin(k * i + k)); };
    soup.push_back({{wave(1.7), wave(2.3), wave(0.7) * 0.5f + 0.5f, 1},
                    {wave(3.1) * 0.5f + 0.5f, wave(0.9), wave(1.3), 1}});
  }
  frame.draw(soup);
  const Result one = frame.render({Mode::kIdeal, {}, {}, {}, 1}),
               three = frame.render({Mode::kIdeal, {}, {}, {}, 3});
  CHECK(one.color == three.color);
  CHECK(one.depth == three.depth);
  CHECK(one.triangle_id == three.triangle_id);
  CHECK(std::set<std::uint32_t>(one.color.begin(), one.color.end()).size() > 100);
  const Result part = frame.render({Mode::kIdeal, {}, {}, PixelRect{5, 9, 30, 21}, 2});
  for (std::size_t y = 0; y < 64; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      const bool inside = x >= 5 && x < 35 && y >= 9 && y < 30;
      CHECK(part.color[y * 64 + x] == (inside ? one.color[y * 64 + x] : 0u));
    }
  }
}

TEST_CASE("render: only the last pass is seen, and draws are numbered through the stream") {
  TestFrame frame(4, 4);
  frame.pipeline();
  frame.draw(full_screen({1, 1, 1, 1}));
  frame.stream.commands.push_back(traces::EndPass{});
  frame.stream.commands.push_back(traces::make_pass(frame.stream, {4, 4}, {0, 0, 0, 0}));
  CHECK(count_covered(frame.render()) == 0);
  frame.draw(full_screen({0, 1, 0, 1}));
  CHECK(frame.render().triangle_id[0] >> 32 == 1);
}

TEST_CASE(
    "render: vertices that are not finite, w of zero or less, and degenerate triangles draw nothing and "
    "crash nothing") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  TestFrame frame(16, 16);
  frame.pipeline().depth_clamp = true;
  const Vertex a = at(0, 0), b = at(16, 0);
  for (const std::array<float, 4> p : {std::array<float, 4>{nan, 0, 0, 1}, {0, inf, 0, 1}, {0, 0, 0, nan}})
    frame.draw({a, b, {p, {1, 1, 1, 1}}});
  frame.draw({{{0, 0, 0, 0}, {}}, {{1, 0, 0, 0}, {}}, {{0, 1, 0, -1}, {}}});
  frame.draw({a, b, b});
  frame.draw({a, b, {{1e38f, -1e38f, 0, 1e-38f}, {}}});
  frame.draw({});
  frame.draw({a, b});
  CHECK(count_covered(frame.render()) == 0);
}
