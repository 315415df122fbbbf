/// Runs a GLSL fragment shader in the reference's interpreter on four lanes, with inputs given as numbers.
#pragma once

#include "models/reference/shader_program.h"
#include "scenes/material/glsl.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::models::reference::test {

inline traces::Shader glsl(std::string_view source,
                           traces::ShaderStage stage = traces::ShaderStage::kFragment) {
  return {"test", stage, scenes::compile_glsl(source, stage, "test")};
}

using LaneValues = std::array<double, kLanes>;

/// Inputs: `layout(location = 0) in vec4 a; (1) b; (2) c; (3) flat in ivec4 i; (4) flat in ivec4 j;`. Output
/// `o` (vec4) and `oi` (ivec4). Lanes take consecutive values so that every lane sees other operands.
class LaneShader {
 public:
  explicit LaneShader(const std::string& body, const std::string& before_main = "")
      : program_(decode_shader(
            glsl("#version 450\n"
                 "layout(location = 0) in vec4 a; layout(location = 1) in vec4 b; layout(location = 2) in "
                 "vec4 c;\n"
                 "layout(location = 3) flat in ivec4 i; layout(location = 4) flat in ivec4 j;\n"
                 "layout(location = 0) out vec4 o; layout(location = 1) out ivec4 oi;\n" +
                 before_main + "\nvoid main() { o = vec4(0); oi = ivec4(0);\n" + body + "\n}\n"))) {
    lanes.cells = program_.initial;
    lanes.textures = &textures;
    lanes.discard_margin.fill(std::numeric_limits<double>::infinity());
  }

  void set(std::uint32_t location, std::uint32_t component, const LaneValues& values) {
    for (int lane = 0; lane < kLanes; ++lane)
      cell(program_.inputs, location, component).set_f(lane, values[static_cast<std::size_t>(lane)]);
  }
  void set_int(std::uint32_t location, std::uint32_t component, std::array<std::int32_t, kLanes> values) {
    for (int lane = 0; lane < kLanes; ++lane) {
      cell(program_.inputs, location, component)
          .set_u(lane, static_cast<std::uint32_t>(values[static_cast<std::size_t>(lane)]));
    }
  }
  void run() { execute(program_, lanes, kAllLanes); }

  double out(int lane, std::uint32_t component = 0) { return cell(program_.outputs, 0, component).f(lane); }
  std::int32_t out_int(int lane, std::uint32_t component = 0) {
    return static_cast<std::int32_t>(cell(program_.outputs, 1, component).u(lane));
  }
  [[nodiscard]] const ShaderProgram& program() const { return program_; }

  Lanes lanes;
  std::vector<TextureView> textures;

 private:
  Cell& cell(const std::vector<Port>& ports, std::uint32_t location, std::uint32_t component) {
    for (const Port& port : ports) {
      if (port.location == location && port.component == component) return lanes.cells[port.slot];
    }
    return unused_;  // the compiler removed an input that the body does not read
  }

  ShaderProgram program_;
  Cell unused_;
};

}  // namespace quadrille::models::reference::test
