// Which triangle is seen: a number for each triangle of the frame, spread over the 32 bits of the colour by a multiplication that can be undone.
void main() {
  alpha_test(read_base_color().a);
  uint code = (draw.first_triangle + uint(gl_PrimitiveID) + 1u) * 2654435761u;
  out_color = vec4(uvec4(code, code >> 8, code >> 16, code >> 24) & 255u) / 255.0;
}
