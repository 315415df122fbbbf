/// The vertex shader of a triangle that holds the picture. A draw of it has three vertices and no stream.
#pragma once

#include <string_view>

namespace quadrille::scenes {

/// `uv` at location 0 runs over the picture, from 0 at its upper left corner to 1.
inline constexpr std::string_view kScreenTriangle = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
  uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
}
)";

}  // namespace quadrille::scenes
