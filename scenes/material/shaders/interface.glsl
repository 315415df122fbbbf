// What every material shader sees; docs/shaders.md explains each member. Set before this: LIGHTS (size of the array, at least 1).
#version 450
#extension GL_EXT_control_flow_attributes : require

struct Light {
  vec4 position;   // point, spot: xyz relative to the eye; w: 1 / range, 0 for unlimited
  vec4 direction;  // xyz: unit vector against the way the light travels (directional, spot)
  vec4 color;      // rgb: linear, times intensity
  vec4 cone;       // spot: saturate(cosine * x + y) squared is the falloff
};

layout(set = 0, binding = 0, std140) uniform Frame {
  mat4 view_projection;
  vec4 eye;            // xyz: world position of the camera; w: in a picture of depths, the depth that is white
  vec4 toward_viewer;  // xyz: unit vector against the view direction; w: there, 1 / the range of depths
  vec4 sky;            // rgb: radiance from straight above
  vec4 ground;         // rgb: radiance from straight below
  Light lights[LIGHTS];
} frame;

layout(push_constant) uniform PerDraw {
  mat4 model;            // byte 0
  mat3 normal_matrix;    // byte 64: inverse transpose of the model matrix
  uint draw_id;          // byte 112: number of the draw
  uint first_triangle;   // byte 116: triangles of all draws before it
  float handedness;      // byte 120: -1 where the model matrix, or the skin, mirrors, else 1
} draw;
