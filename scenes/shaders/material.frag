// Fragment shader of all materials: glTF's metallic-roughness model (its appendix B) under the scene's lights and a two-colour sky.
const float kMinAlpha = 0.002;  // squared roughness: keeps the highlight of a mirror finite

vec3 emitted() {
  vec3 color = material.emissive.rgb;
#ifdef EMISSIVE_UV
  color *= texture(emissive_texture, EMISSIVE_UV).rgb;
#endif
  return color;
}

#ifndef UNLIT
#ifdef NORMAL_UV
// Moves the normal-map sample into world space. Green points along -v, as glTF asks.
vec3 perturb(vec3 n, vec3 m) {
#ifdef HAS_TANGENT
  return m.x * v_tangent.xyz + m.y * v_tangent.w * cross(n, v_tangent.xyz) + m.z * n;
#else
  // No tangents in the file: the frame that the texture coordinates span on the surface, from screen-space differences.
  vec2 uv = NORMAL_UV;
  vec3 px = dFdx(v_position), py = dFdy(v_position);
  vec2 tx = dFdx(uv), ty = dFdy(uv);
  vec3 across_y = cross(n, py), across_x = cross(px, n);  // window y points down, so these turn the other way than with y up
  vec3 t = across_y * tx.x + across_x * ty.x;
  vec3 b = across_y * tx.y + across_x * ty.y;
  float scale = inversesqrt(max(max(dot(t, t), dot(b, b)), 1e-30));
  return (m.x * scale) * t - (m.y * scale) * b + m.z * n;
#endif
}
#endif

vec3 shading_normal() {
#ifdef HAS_NORMAL
  vec3 n = normalize(v_normal);
#else
  vec3 n = normalize(cross(dFdy(v_position), dFdx(v_position)));  // flat, toward the viewer
#endif
#ifdef NORMAL_UV
  vec3 m = texture(normal_texture, NORMAL_UV).xyz * 2.0 - 1.0;
  m.xy *= material.factors.z;
  n = normalize(perturb(n, m));
#endif
#if defined(DOUBLE_SIDED) && defined(HAS_NORMAL)
  n = gl_FrontFacing ? n : -n;
#endif
  return n;
}

struct Surface {
  vec3 n, v, diffuse, f0;
  float n_dot_v, alpha, roughness, occlusion;
};

// Radiance that leaves toward the viewer per unit of irradiance from `l` at normal incidence, times pi and the cosine.
// Trowbridge-Reitz distribution, Smith visibility in Hammon's approximation, Schlick Fresnel.
vec3 reflect_light(Surface s, vec3 l) {
  float n_dot_l = clamp(dot(s.n, l), 0.0, 1.0);
  vec3 h = normalize(l + s.v);
  float n_dot_h = clamp(dot(s.n, h), 0.0, 1.0);
  float v_dot_h = clamp(dot(s.v, h), 0.0, 1.0);
  float a2 = s.alpha * s.alpha;
  float d = (n_dot_h * a2 - n_dot_h) * n_dot_h + 1.0;
  float visibility = 0.5 / (mix(2.0 * n_dot_l * s.n_dot_v, n_dot_l + s.n_dot_v, s.alpha) + 1e-4);
  float specular = a2 * visibility / (d * d);
  float k = 1.0 - v_dot_h;
  float k2 = k * k;
  vec3 fresnel = s.f0 + (1.0 - s.f0) * (k2 * k2 * k);
  return (s.diffuse * (1.0 - fresnel) + specular * fresnel) * n_dot_l;
}

// Light of the sky and the ground: irradiance is a blend by the normal's height; the reflection blurs the horizon by roughness. The directional
// albedo of the specular lobe is Karis' fit (Physically Based Shading on Mobile, 2014).
vec3 reflect_environment(Surface s) {
  vec3 irradiance = mix(frame.ground.rgb, frame.sky.rgb, s.n.y * 0.5 + 0.5);
  float up = 2.0 * dot(s.n, s.v) * s.n.y - s.v.y;
  vec3 radiance = mix(frame.ground.rgb, frame.sky.rgb, clamp(up / (2.0 * s.roughness + 0.2) + 0.5, 0.0, 1.0));
  vec4 r = s.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * s.n_dot_v)) * r.x + r.y;
  vec3 specular = s.f0 * (r.z - 1.04 * a) + (r.w + 1.04 * a);
  return (s.diffuse * irradiance + specular * radiance) * s.occlusion;
}

#if POINT_LIGHTS + SPOT_LIGHTS > 0
// Inverse square with the smooth cut at the range that KHR_lights_punctual recommends.
float attenuation(Light light, float distance_squared) {
  float x = distance_squared * light.position.w * light.position.w;
  return clamp(1.0 - x * x, 0.0, 1.0) / max(distance_squared, 1e-4);
}
#endif

// Lights come in the order directional, point, spot; every intensity is divided by pi on the host.
vec3 reflect_lights(Surface s) {
  vec3 sum = vec3(0.0);
  LOOP_HINT for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i) sum += frame.lights[i].color.rgb * reflect_light(s, frame.lights[i].direction.xyz);
#if POINT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - v_position;
    float distance_squared = dot(to_light, to_light);
    sum += frame.lights[i].color.rgb * (attenuation(frame.lights[i], distance_squared) * reflect_light(s, to_light * inversesqrt(max(distance_squared, 1e-12))));
  }
#endif
#if SPOT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS + POINT_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS + SPOT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - v_position;
    float distance_squared = dot(to_light, to_light);
    vec3 l = to_light * inversesqrt(max(distance_squared, 1e-12));
    float cone = clamp(dot(frame.lights[i].direction.xyz, l) * frame.lights[i].cone.x + frame.lights[i].cone.y, 0.0, 1.0);
    sum += frame.lights[i].color.rgb * (attenuation(frame.lights[i], distance_squared) * cone * cone * reflect_light(s, l));
  }
#endif
  return sum;
}

Surface surface(vec3 base) {
  Surface s;
  float metallic = material.factors.x, roughness = material.factors.y;
  s.occlusion = 1.0;
#ifdef METALLIC_ROUGHNESS_UV
  vec4 sampled = texture(metallic_roughness_texture, METALLIC_ROUGHNESS_UV);
  metallic *= sampled.b;
  roughness *= sampled.g;
#endif
#ifdef OCCLUSION_IN_METALLIC_ROUGHNESS
  s.occlusion = 1.0 + material.factors.w * (sampled.r - 1.0);
#endif
#ifdef OCCLUSION_UV
  s.occlusion = 1.0 + material.factors.w * (texture(occlusion_texture, OCCLUSION_UV).r - 1.0);
#endif
  s.n = shading_normal();
#ifdef ORTHOGRAPHIC
  s.v = frame.toward_viewer.xyz;
#else
  s.v = normalize(-v_position);
#endif
  s.n_dot_v = clamp(dot(s.n, s.v), 0.0, 1.0);
  s.roughness = roughness;
  s.alpha = max(roughness * roughness, kMinAlpha);
  s.diffuse = base * (1.0 - metallic);
  s.f0 = mix(vec3(0.04), base, metallic);
  return s;
}
#endif  // !UNLIT

void main() {
  vec4 base = read_base_color();
  alpha_test(base.a);
#ifdef UNLIT
  vec3 color = base.rgb;
#else
  Surface s = surface(base.rgb);
  vec3 color = reflect_lights(s) + reflect_environment(s);
#ifdef EMISSIVE
  color += emitted();
#endif
#endif
#ifdef ALPHA_BLEND
  out_color = vec4(color, base.a);
#else
  out_color = vec4(color, 1.0);
#endif
}
