#version 450
// Second pass of an overdraw picture: colours for the numbers of fragments that the first pass has added up. Every number up to 16 has its own.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(set = 0, binding = 0) uniform sampler2D color;

vec3 between(vec3 a, vec3 b, float from, float to, float count) { return mix(a, b, clamp((count - from) / (to - from), 0.0, 1.0)); }

void main() {
  float count = floor(textureLod(color, uv, 0.0).r * 255.0 + 0.5);
  vec3 scale = between(vec3(0.0, 0.15, 0.5), vec3(0.0, 0.65, 0.8), 1.0, 2.0, count);
  scale = count > 2.0 ? between(vec3(0.0, 0.65, 0.8), vec3(0.2, 0.8, 0.2), 2.0, 4.0, count) : scale;
  scale = count > 4.0 ? between(vec3(0.2, 0.8, 0.2), vec3(1.0, 0.85, 0.0), 4.0, 6.0, count) : scale;
  scale = count > 6.0 ? between(vec3(1.0, 0.85, 0.0), vec3(0.9, 0.1, 0.0), 6.0, 10.0, count) : scale;
  scale = count > 10.0 ? between(vec3(0.9, 0.1, 0.0), vec3(1.0), 10.0, 16.0, count) : scale;
  result = vec4(count > 0.0 ? scale : vec3(0.0), 1.0);
}
