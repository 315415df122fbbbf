#include "scenes/material/spirv_bindings.h"

#include <catch2/catch.hpp>

#include "scenes/material/glsl.h"

namespace quadrille::scenes {
namespace {

TEST_CASE("bindings that a shader declares but does not read are not mentioned") {
  const auto spirv = compile_glsl(R"(#version 450
layout(set = 1, binding = 1) uniform sampler2D read;
layout(set = 1, binding = 2) uniform sampler2D idle;
layout(set = 0, binding = 3) uniform sampler2D elsewhere;
layout(location = 0) out vec4 color;
void main() { color = texture(read, vec2(0.5)) + texture(elsewhere, vec2(0.5)); }
)",
                                  traces::ShaderStage::kFragment, "some.frag", {});
  CHECK(mentioned_bindings(spirv, 1) == std::set<std::uint32_t>{1});
  CHECK(mentioned_bindings(spirv, 0) == std::set<std::uint32_t>{3});
  CHECK(mentioned_bindings(spirv, 2).empty());
}

TEST_CASE("damaged modules mention what comes before the damage") {
  CHECK(mentioned_bindings({}, 1).empty());
  const std::vector<std::uint32_t> zero_length{0x07230203, 0x10300, 0, 9, 0, 0, 0};
  CHECK(mentioned_bindings(zero_length, 1).empty());
  const std::vector<std::uint32_t> beyond_the_end{0x07230203, 0x10300, 0, 9, 0, (9u << 16) | 71};
  CHECK(mentioned_bindings(beyond_the_end, 1).empty());
}

}  // namespace
}  // namespace quadrille::scenes
