// The pose of a mesh (scenes/record/pose_streams.h): which targets have weight and how many joints there are decides what is declared.
#if defined(POSE_JOINTS) || defined(POSE_WEIGHTS)
layout(set = 2, binding = 0, std140) uniform Pose {
#ifdef POSE_WEIGHTS
  vec4 weights[POSE_WEIGHTS];  // of the morph targets, four a vector
#endif
#ifdef POSE_JOINTS
  vec4 joints[3 * POSE_JOINTS];  // the rows of each joint's matrix
#endif
} pose;
#endif

#ifdef POSE_WEIGHTS
POSE_DELTAS
#endif

#ifdef POSE_JOINTS
layout(location = 6) in uvec4 joints_0;
layout(location = 7) in vec4 weights_0;
#ifdef POSE_EIGHT_JOINTS
layout(location = 8) in uvec4 joints_1;
layout(location = 9) in vec4 weights_1;
#endif

// The rows of a vertex's own matrix: the mean of its joints'.
struct Skin { vec4 x, y, z; };

void add_joint(inout Skin skin, uint joint, float weight) {
  skin.x += weight * pose.joints[3u * joint];
  skin.y += weight * pose.joints[3u * joint + 1u];
  skin.z += weight * pose.joints[3u * joint + 2u];
}

Skin skin_of_vertex() {
  Skin skin = Skin(vec4(0.0), vec4(0.0), vec4(0.0));
  add_joint(skin, joints_0.x, weights_0.x);
  add_joint(skin, joints_0.y, weights_0.y);
  add_joint(skin, joints_0.z, weights_0.z);
  add_joint(skin, joints_0.w, weights_0.w);
#ifdef POSE_EIGHT_JOINTS
  add_joint(skin, joints_1.x, weights_1.x);
  add_joint(skin, joints_1.y, weights_1.y);
  add_joint(skin, joints_1.z, weights_1.z);
  add_joint(skin, joints_1.w, weights_1.w);
#endif
  return skin;
}

vec3 turned(Skin skin, vec3 v) { return vec3(dot(skin.x.xyz, v), dot(skin.y.xyz, v), dot(skin.z.xyz, v)); }

// By cofactors: perpendicular to what the matrix makes of a surface, for a flattening matrix too.
vec3 turned_normal(Skin skin, vec3 n) {
  vec3 v = vec3(dot(cross(skin.y.xyz, skin.z.xyz), n), dot(cross(skin.z.xyz, skin.x.xyz), n), dot(cross(skin.x.xyz, skin.y.xyz), n));
  return v * inversesqrt(max(dot(v, v), 1e-30));
}
#endif
