#include "tests/pipeline/compiler/shader_runner.h"

#include "scenes/material/glsl.h"

#include <algorithm>
#include <bit>

namespace quadrille::pipeline {

using models::kWarpLanes;

std::string fragment_source(const std::string& body, const std::string& declarations) {
  return "#version 450\nlayout(location=0) in vec4 a; layout(location=1) in vec4 b; layout(location=2) flat "
         "in ivec4 i; layout(location=0) "
         "out vec4 color;\n" +
         declarations + "\nvoid main() {\n" + body + "\n}\n";
}

std::string plain_vertex_source() {
  return R"(#version 450
layout(location=0) in vec4 p;
layout(location=0) out vec4 a; layout(location=1) out vec4 b; layout(location=2) flat out ivec4 i;
void main() { gl_Position = p; a = p; b = p; i = ivec4(gl_VertexIndex); })";
}

std::vector<std::uint32_t> fragment_spirv(const std::string& source) {
  return scenes::compile_glsl(source, traces::ShaderStage::kFragment, "test.frag");
}
std::vector<std::uint32_t> vertex_spirv(const std::string& source) {
  return scenes::compile_glsl(source, traces::ShaderStage::kVertex, "test.vert");
}

models::Program compile_fragment(const std::string& source, const ShaderTarget& target) {
  static const std::vector<std::uint32_t> vertex = vertex_spirv(plain_vertex_source());
  return compile_pipeline(vertex, "test.vert", fragment_spirv(source), "test.frag", target).fragment;
}

std::vector<std::uint32_t> constant_file(const models::ConstantLayout& layout, const RunInput& input) {
  using Source = models::ConstantLayout::Source;
  std::vector<std::uint32_t> file(layout.words, 0xdeadbeefu);
  for (const auto& range : layout.ranges)
    for (std::uint32_t k = 0; k < range.words; ++k) {
      if (range.source == Source::kLiteral) {
        file.at(range.first_word + k) = range.literals.at(k);
        continue;
      }
      const auto block = input.blocks.find({range.set, range.binding});
      const std::vector<std::uint32_t>& words =
          range.source == Source::kPushConstant ? input.push_constants : block->second;
      const std::uint32_t at = range.byte_offset / 4 + k;
      if (at < words.size()) file.at(range.first_word + k) = words[at];
    }
  return file;
}

namespace {

void answer_textures(models::Warp& warp, const RunInput& input) {
  for (int t = 0; t < warp.texture_count; ++t) {
    const models::TextureRequest& request = warp.textures[static_cast<std::size_t>(t)];
    std::array<models::LaneFloats, 4> rgba{};
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      const float level = request.op == models::Op::kTexImplicit ? 0.0f : request.lod[lane];
      const Vec4 texel = input.texture(request.binding, request.u[lane], request.v[lane], level);
      for (std::size_t c = 0; c < 4; ++c) rgba[c][lane] = texel[c];
    }
    models::write_texture_result(warp, request, rgba);
  }
}

}  // namespace

RunOutput run_fragment(const models::Program& program, const RunInput& input, models::WarpStorage* storage) {
  const std::vector<std::uint32_t> constants = constant_file(program.constants, input);
  models::FragmentInputs in{};
  std::array<std::vector<float>, models::kWarpQuads> planes;
  // The vertex shader's locations 0..2 are packed in order; the layout of a program tells which components
  // are there by count only, so all are compiled with every component read (see `run_snippet`).
  for (std::size_t q = 0; q < models::kWarpQuads; ++q) {
    const Point& p = input.points[q];
    for (std::size_t k = 0; k < program.varyings.size(); ++k) {
      const float value = k < 4 ? p.a[k] : k < 8 ? p.b[k - 4] : std::bit_cast<float>(p.i[(k - 8) % 4]);
      planes[q].insert(planes[q].end(), {value, 0.0f, 0.0f});
    }
    planes[q].resize(std::max<std::size_t>(planes[q].size(), 3));
    in.varyings[q] = planes[q].data();
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
      const std::size_t lane = 4 * q + pixel;
      in.x[lane] = 10.5f + 2.0f * static_cast<float>(q) + static_cast<float>(pixel % 2);
      in.y[lane] = 20.5f + static_cast<float>(pixel >> 1);
      in.z[lane] = 0.25f;
      in.inv_w[lane] = 0.5f;
      in.front_facing[lane] = q % 2 == 0 ? 0xffffffffu : 0u;
      in.primitive_id[lane] = static_cast<std::uint32_t>(q);
    }
  }
  std::array<models::LaneWords, models::kFragmentOutputs> outputs{};
  const std::vector<models::TextureSize> sizes(program.textures.size(), {64, 32, 7});
  models::Warp warp;
  warp.fragment = &in;
  warp.outputs = outputs.data();
  warp.texture_sizes = sizes.data();
  warp.storage = storage;
  warp.launch(program, constants.data(), 0xffffffffu);
  RunOutput out;
  for (;;) {
    ++out.clauses;
    if (models::run_clause(warp).end == models::ClauseEnd::kProgramEnd) break;
    answer_textures(warp, input);
  }
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    for (std::size_t c = 0; c < 4; ++c) out.color[lane][c] = std::bit_cast<float>(outputs[c][lane]);
    out.depth[lane] = std::bit_cast<float>(outputs[models::kDepthOutput][lane]);
  }
  out.killed = warp.killed;
  return out;
}

/// Reads every component in a branch that no point takes (i.w is never this number), so that the packed
/// varyings are a, b, i in order.
RunOutput run_snippet(const std::string& body, const RunInput& input, const std::string& declarations) {
  const std::string keep = "if (i.w == -123456789) { color = a + b + vec4(i); return; }\n";
  return run_fragment(compile_fragment(fragment_source(keep + body, declarations)), input);
}

Points assorted_points(std::uint32_t seed) {
  Random random(seed);
  const auto unit = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  Points points{};
  for (Point& p : points) {
    for (float& v : p.a) v = unit() * 8.0f - 4.0f;
    for (float& v : p.b) v = unit() * 2.0f + 0.125f;
    for (std::int32_t& v : p.i) v = static_cast<std::int32_t>(random() % 41) - 20;
  }
  return points;
}

std::vector<models::LaneWords> run_vertex(const models::Program& program,
                                          const std::function<float(int, int, int)>& attribute,
                                          const RunInput& input) {
  const std::vector<std::uint32_t> constants = constant_file(program.constants, input);
  std::vector<models::LaneWords> rows(program.vertex_inputs.size());
  models::VertexInputs in{};
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (int lane = 0; lane < kWarpLanes; ++lane)
      rows[k][static_cast<std::size_t>(lane)] = std::bit_cast<std::uint32_t>(
          attribute(program.vertex_inputs[k].location, program.vertex_inputs[k].component, lane));
  for (std::uint32_t lane = 0; lane < kWarpLanes; ++lane) {
    in.vertex_index[lane] = 100 + lane;
    in.instance_index[lane] = 7;
  }
  in.attributes = rows.data();
  std::vector<models::LaneWords> outputs(static_cast<std::size_t>(models::vertex_outputs(program)));
  models::Warp warp;
  warp.vertex = &in;
  warp.outputs = outputs.data();
  warp.launch(program, constants.data(), 0xffffffffu);
  while (models::run_clause(warp).end != models::ClauseEnd::kProgramEnd) answer_textures(warp, input);
  return outputs;
}

}  // namespace quadrille::pipeline
