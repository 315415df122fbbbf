// Light from all around, as a map of it (docs/environment.md), for shaders that are compiled with ENVIRONMENT.
#ifdef ENVIRONMENT
layout(set = 0, binding = 1, std140) uniform Environment {
  vec4 irradiance[9];  // what a white diffuse surface shows: times 1, y, z, x, xy, yz, 3zz - 1, xz, xx - yy of its normal
  vec4 turn[3];        // rows of a matrix from the world to the map
  vec4 ways[3];        // background: direction in the middle of the picture; what a half width adds to the right, a half height downwards
  vec4 range;          // x: radiance of a texel of one; y: the map's last level
} environment;
layout(set = 0, binding = 2) uniform samplerCube environment_map;

vec3 in_map(vec3 d) {
#ifdef ENVIRONMENT_TURNED
  return vec3(dot(environment.turn[0].xyz, d), dot(environment.turn[1].xyz, d), dot(environment.turn[2].xyz, d));
#else
  return d;
#endif
}

// What comes from around a direction, blurred for a mirror of this roughness.
vec3 environment_radiance(vec3 direction, float roughness) {
  return textureLod(environment_map, in_map(direction), roughness * environment.range.y).rgb * environment.range.x;
}

#ifdef NEEDS_POSITION
layout(set = 0, binding = 3) uniform sampler2D lobe_table;

// Radiance of a white diffuse surface.
vec3 environment_irradiance(vec3 normal) {
  vec3 n = in_map(normal);
  vec3 sum = environment.irradiance[0].rgb + environment.irradiance[1].rgb * n.y + environment.irradiance[2].rgb * n.z + environment.irradiance[3].rgb * n.x;
  sum += environment.irradiance[4].rgb * (n.x * n.y) + environment.irradiance[5].rgb * (n.y * n.z) + environment.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0);
  sum += environment.irradiance[7].rgb * (n.x * n.z) + environment.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
  return max(sum, vec3(0.0));
}

// Where most of what a rough mirror shows comes from: the rougher, the nearer to the normal. Not of unit length. [P: Lagarde and de Rousiers 2014]
vec3 mirrored(vec3 n, vec3 v, float roughness) {
  float alpha = roughness * roughness, smoothness = max(1.0 - alpha, 0.0);
  return mix(n, reflect(-v, n), smoothness * (sqrt(smoothness) + alpha));
}

// The specular lobe's directional albedo: x times f0 plus y times f90. The table's outer texels are for 0 and 1.
vec2 lobe_albedo(float roughness, float n_dot_v) {
  return textureLod(lobe_table, vec2(n_dot_v, roughness) * (31.0 / 32.0) + 0.5 / 32.0, 0.0).rg;
}

// What light that meets the lobe's facets more than once adds, as a share of the irradiance, after Fdez-Aguera: with it a white metal is white at every roughness.
vec3 again_reflected(vec3 once, vec3 f0, vec3 f90, vec2 lobe) {
  float missed = 1.0 - lobe.x - lobe.y;
  vec3 mean = f0 + (f90 - f0) / 21.0;
  return once * mean * missed / (1.0 - mean * missed);
}
#endif
#endif
