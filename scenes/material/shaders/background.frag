// The environment itself, where nothing stands before it.
layout(location = 0) in vec3 way;
layout(location = 0) out vec4 out_color;
void main() { out_color = vec4(environment_radiance(way, 0.0), 1.0); }
