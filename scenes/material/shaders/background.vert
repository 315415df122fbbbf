// A triangle that holds the picture, behind everything, with the direction of each pixel.
layout(location = 0) out vec3 way;
void main() {
  vec2 place = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
  way = environment.ways[0].xyz + place.x * environment.ways[1].xyz + place.y * environment.ways[2].xyz;
  gl_Position = vec4(place, 1.0, 1.0);
}
