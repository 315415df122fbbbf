// Vertex shader of all materials. A define for each stream that the primitive has and the fragment shader reads.
layout(location = 0) in vec3 position;
#ifdef HAS_NORMAL
layout(location = 1) in vec3 normal;
#ifdef LIT_AT_VERTICES
vec3 v_normal;
#else
layout(location = 1) out vec3 v_normal;
#endif
#endif
#ifdef HAS_TANGENT
layout(location = 2) in vec4 tangent;
layout(location = 2) out vec4 v_tangent;
#endif
#ifdef HAS_UV0
layout(location = 3) in vec2 uv0;
layout(location = 3) out vec2 v_uv0;
#endif
#ifdef HAS_UV1
layout(location = 4) in vec2 uv1;
layout(location = 4) out vec2 v_uv1;
#endif
#ifdef HAS_COLOR
layout(location = 5) in vec4 color;
layout(location = 5) out vec4 v_color;
#endif
#ifdef LIT_AT_VERTICES
vec3 v_position;
#elif defined(NEEDS_POSITION)
layout(location = 0) out vec3 v_position;  // world axes, relative to the eye: differences stay exact far from the origin
#endif
#ifdef LIT_AT_VERTICES
layout(location = 6) ACROSS out vec3 v_diffuse;
layout(location = 7) ACROSS out vec3 v_specular;
#ifdef DOUBLE_SIDED
layout(location = 8) ACROSS out vec3 v_back_diffuse;
layout(location = 9) ACROSS out vec3 v_back_specular;
#endif
#endif

// Model and normal matrix: of the draw, or of each of its instances.
#ifdef INSTANCED
layout(location = 10) in vec4 model_row_0;
layout(location = 11) in vec4 model_row_1;
layout(location = 12) in vec4 model_row_2;
layout(location = 13) in vec3 normal_column_0;
layout(location = 14) in vec3 normal_column_1;
layout(location = 15) in vec3 normal_column_2;
#define MODEL transpose(mat4(model_row_0, model_row_1, model_row_2, vec4(0.0, 0.0, 0.0, 1.0)))
#define NORMAL_MATRIX mat3(normal_column_0, normal_column_1, normal_column_2)
#else
#define MODEL draw.model
#define NORMAL_MATRIX draw.normal_matrix
#endif

void main() {
  vec3 at = position;
#ifdef POSE_POSITION
  at += POSE_POSITION;
#endif
#ifdef POSE_JOINTS
  Skin skin = skin_of_vertex();
  at = turned(skin, at) + vec3(skin.x.w, skin.y.w, skin.z.w);
#endif
  vec4 world = MODEL * vec4(at, 1.0);
  gl_Position = frame.view_projection * world;
#ifdef POINT_SIZE
  gl_PointSize = POINT_SIZE;
#endif
#ifdef NEEDS_POSITION
  v_position = world.xyz - frame.eye.xyz;
#endif
#ifdef HAS_NORMAL
  vec3 up = normal;
#ifdef POSE_NORMAL
  up += POSE_NORMAL;
#endif
#ifdef POSE_JOINTS
  up = turned_normal(skin, up);
#endif
  v_normal = NORMAL_MATRIX * up;
#endif
#ifdef HAS_TANGENT
  vec3 along = tangent.xyz;
#ifdef POSE_TANGENT
  along += POSE_TANGENT;
#endif
#ifdef POSE_JOINTS
  along = turned(skin, along);
#endif
  along = mat3(MODEL) * along;
  v_tangent = vec4(along * inversesqrt(max(dot(along, along), 1e-30)), tangent.w * draw.handedness);
#endif
#ifdef HAS_UV0
  v_uv0 = uv0;
#endif
#ifdef HAS_UV1
  v_uv1 = uv1;
#endif
#ifdef HAS_COLOR
  v_color = color;
#endif
#ifdef LIT_AT_VERTICES
  Reflected front = reflect_lights(unit(v_normal), v_position);
  v_diffuse = front.diffuse;
  v_specular = front.specular;
#ifdef DOUBLE_SIDED
  Reflected back = reflect_lights(-unit(v_normal), v_position);
  v_back_diffuse = back.diffuse;
  v_back_specular = back.specular;
#endif
#endif
}
