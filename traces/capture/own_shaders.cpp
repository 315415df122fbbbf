/// Shaders of clears and copies that a frame's commands ask for. Each is what glslangValidator 12 and
/// spirv-opt make of the GLSL above it.
#include "traces/capture/own_shaders.h"

#include <span>

namespace quadrille::capture {
namespace {

// clang-format off: words fill their lines
//     #version 450
//     layout(push_constant) uniform Area { vec4 color; vec4 source; float depth; } area;
//     layout(location = 0) out vec2 place;
//     void main() {
//       vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
//       place = area.source.xy + corner * area.source.zw;
//       gl_Position = vec4(corner * 2.0 - 1.0, area.depth, 1.0);
//     }
constexpr std::uint32_t kArea[] = {
    0x7230203,  0x10000,    0x8000b, 0x3d,    0,       0x20011, 1,       0x6000b,    1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x8000f, 0,          4,       0x6e69616d,
    0,          0xc,        0x18,    0x2c,    0x40047, 0xc,     0xb,     0x2a,       0x40047, 0x18,
    0x1e,       0,          0x50048, 0x1a,    0,       0x23,    0,       0x50048,    0x1a,    1,
    0x23,       0x10,       0x50048, 0x1a,    2,       0x23,    0x20,    0x30047,    0x1a,    2,
    0x50048,    0x2a,       0,       0xb,     0,       0x50048, 0x2a,    1,          0xb,     1,
    0x50048,    0x2a,       2,       0xb,     3,       0x50048, 0x2a,    3,          0xb,     4,
    0x30047,    0x2a,       2,       0x20013, 2,       0x30021, 3,       2,          0x30016, 6,
    0x20,       0x40017,    7,       6,       2,       0x40015, 0xa,     0x20,       1,       0x40020,
    0xb,        1,          0xa,     0x4003b, 0xb,     0xc,     1,       0x4002b,    0xa,     0xe,
    1,          0x4002b,    0xa,     0x10,    2,       0x40020, 0x17,    3,          7,       0x4003b,
    0x17,       0x18,       3,       0x40017, 0x19,    6,       4,       0x5001e,    0x1a,    0x19,
    0x19,       6,          0x40020, 0x1b,    9,       0x1a,    0x4003b, 0x1b,       0x1c,    9,
    0x40020,    0x1d,       9,       0x19,    0x40015, 0x27,    0x20,    0,          0x4002b, 0x27,
    0x28,       1,          0x4001c, 0x29,    6,       0x28,    0x6001e, 0x2a,       0x19,    6,
    0x29,       0x29,       0x40020, 0x2b,    3,       0x2a,    0x4003b, 0x2b,       0x2c,    3,
    0x4002b,    0xa,        0x2d,    0,       0x4002b, 6,       0x2f,    0x40000000, 0x4002b, 6,
    0x31,       0x3f800000, 0x40020, 0x34,    9,       6,       0x40020, 0x3a,       3,       0x19,
    0x5002c,    7,          0x3c,    0x31,    0x31,    0x50036, 2,       4,          0,       3,
    0x200f8,    5,          0x4003d, 0xa,     0xd,     0xc,     0x500c4, 0xa,        0xf,     0xd,
    0xe,        0x500c7,    0xa,     0x11,    0xf,     0x10,    0x4006f, 6,          0x12,    0x11,
    0x500c7,    0xa,        0x14,    0xd,     0x10,    0x4006f, 6,       0x15,       0x14,    0x50050,
    7,          0x16,       0x12,    0x15,    0x50041, 0x1d,    0x1e,    0x1c,       0xe,     0x4003d,
    0x19,       0x1f,       0x1e,    0x7004f, 7,       0x20,    0x1f,    0x1f,       0,       1,
    0x7004f,    7,          0x24,    0x1f,    0x1f,    2,       3,       0x8000c,    7,       0x26,
    1,          0x32,       0x16,    0x24,    0x20,    0x3003e, 0x18,    0x26,       0x5008e, 7,
    0x30,       0x16,       0x2f,    0x50083, 7,       0x33,    0x30,    0x3c,       0x50041, 0x34,
    0x35,       0x1c,       0x10,    0x4003d, 6,       0x36,    0x35,    0x50051,    6,       0x37,
    0x33,       0,          0x50051, 6,       0x38,    0x33,    1,       0x70050,    0x19,    0x39,
    0x37,       0x38,       0x36,    0x31,    0x50041, 0x3a,    0x3b,    0x2c,       0x2d,    0x3003e,
    0x3b,       0x39,       0x100fd, 0x10038,
};

//     #version 450
//     layout(push_constant) uniform Area { vec4 color; vec4 source; float depth; } area;
//     layout(location = 0) out vec4 color;
//     void main() { color = area.color; }
constexpr std::uint32_t kClear[] = {
    0x7230203,  0x10000,    0x8000b, 0x12,    0,       0x20011, 1,       0x6000b, 1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x6000f, 4,       4,       0x6e69616d,
    0,          9,          0x30010, 4,       7,       0x40047, 9,       0x1e,    0,       0x50048,
    0xa,        0,          0x23,    0,       0x50048, 0xa,     1,       0x23,    0x10,    0x50048,
    0xa,        2,          0x23,    0x20,    0x30047, 0xa,     2,       0x20013, 2,       0x30021,
    3,          2,          0x30016, 6,       0x20,    0x40017, 7,       6,       4,       0x40020,
    8,          3,          7,       0x4003b, 8,       9,       3,       0x5001e, 0xa,     7,
    7,          6,          0x40020, 0xb,     9,       0xa,     0x4003b, 0xb,     0xc,     9,
    0x40015,    0xd,        0x20,    1,       0x4002b, 0xd,     0xe,     0,       0x40020, 0xf,
    9,          7,          0x50036, 2,       4,       0,       3,       0x200f8, 5,       0x50041,
    0xf,        0x10,       0xc,     0xe,     0x4003d, 7,       0x11,    0x10,    0x3003e, 9,
    0x11,       0x100fd,    0x10038,
};

//     #version 450
//     layout(push_constant) uniform Area { uvec4 color; vec4 source; float depth; } area;
//     layout(location = 0) out uvec4 color;
//     void main() { color = area.color; }
constexpr std::uint32_t kClearUnsigned[] = {
    0x7230203,  0x10000,    0x8000b, 0x14,    0,       0x20011, 1,       0x6000b, 1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x6000f, 4,       4,       0x6e69616d,
    0,          9,          0x30010, 4,       7,       0x40047, 9,       0x1e,    0,       0x50048,
    0xc,        0,          0x23,    0,       0x50048, 0xc,     1,       0x23,    0x10,    0x50048,
    0xc,        2,          0x23,    0x20,    0x30047, 0xc,     2,       0x20013, 2,       0x30021,
    3,          2,          0x40015, 6,       0x20,    0,       0x40017, 7,       6,       4,
    0x40020,    8,          3,       7,       0x4003b, 8,       9,       3,       0x30016, 0xa,
    0x20,       0x40017,    0xb,     0xa,     4,       0x5001e, 0xc,     7,       0xb,     0xa,
    0x40020,    0xd,        9,       0xc,     0x4003b, 0xd,     0xe,     9,       0x40015, 0xf,
    0x20,       1,          0x4002b, 0xf,     0x10,    0,       0x40020, 0x11,    9,       7,
    0x50036,    2,          4,       0,       3,       0x200f8, 5,       0x50041, 0x11,    0x12,
    0xe,        0x10,       0x4003d, 7,       0x13,    0x12,    0x3003e, 9,       0x13,    0x100fd,
    0x10038,
};

//     #version 450
//     layout(push_constant) uniform Area { ivec4 color; vec4 source; float depth; } area;
//     layout(location = 0) out ivec4 color;
//     void main() { color = area.color; }
constexpr std::uint32_t kClearSigned[] = {
    0x7230203,  0x10000,    0x8000b, 0x13,    0,       0x20011, 1,       0x6000b, 1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x6000f, 4,       4,       0x6e69616d,
    0,          9,          0x30010, 4,       7,       0x40047, 9,       0x1e,    0,       0x50048,
    0xc,        0,          0x23,    0,       0x50048, 0xc,     1,       0x23,    0x10,    0x50048,
    0xc,        2,          0x23,    0x20,    0x30047, 0xc,     2,       0x20013, 2,       0x30021,
    3,          2,          0x40015, 6,       0x20,    1,       0x40017, 7,       6,       4,
    0x40020,    8,          3,       7,       0x4003b, 8,       9,       3,       0x30016, 0xa,
    0x20,       0x40017,    0xb,     0xa,     4,       0x5001e, 0xc,     7,       0xb,     0xa,
    0x40020,    0xd,        9,       0xc,     0x4003b, 0xd,     0xe,     9,       0x4002b, 6,
    0xf,        0,          0x40020, 0x10,    9,       7,       0x50036, 2,       4,       0,
    3,          0x200f8,    5,       0x50041, 0x10,    0x11,    0xe,     0xf,     0x4003d, 7,
    0x12,       0x11,       0x3003e, 9,       0x12,    0x100fd, 0x10038,
};

//     #version 450
//     layout(set = 0, binding = 0) uniform sampler2D picture;
//     layout(location = 0) in vec2 place;
//     layout(location = 0) out vec4 color;
//     void main() { color = texture(picture, place); }
constexpr std::uint32_t kCopy[] = {
    0x7230203,  0x10000,    0x8000b, 0x14,    0,       0x20011, 1,       0x6000b, 1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x7000f, 4,       4,       0x6e69616d,
    0,          9,          0x11,    0x30010, 4,       7,       0x40047, 9,       0x1e,    0,
    0x40047,    0xd,        0x22,    0,       0x40047, 0xd,     0x21,    0,       0x40047, 0x11,
    0x1e,       0,          0x20013, 2,       0x30021, 3,       2,       0x30016, 6,       0x20,
    0x40017,    7,          6,       4,       0x40020, 8,       3,       7,       0x4003b, 8,
    9,          3,          0x90019, 0xa,     6,       1,       0,       0,       0,       1,
    0,          0x3001b,    0xb,     0xa,     0x40020, 0xc,     0,       0xb,     0x4003b, 0xc,
    0xd,        0,          0x40017, 0xf,     6,       2,       0x40020, 0x10,    1,       0xf,
    0x4003b,    0x10,       0x11,    1,       0x50036, 2,       4,       0,       3,       0x200f8,
    5,          0x4003d,    0xb,     0xe,     0xd,     0x4003d, 0xf,     0x12,    0x11,    0x50057,
    7,          0x13,       0xe,     0x12,    0x3003e, 9,       0x13,    0x100fd, 0x10038,
};

//     #version 450
//     layout(set = 0, binding = 0) uniform sampler1D picture;
//     layout(location = 0) in vec2 place;
//     layout(location = 0) out vec4 color;
//     void main() { color = texture(picture, place.x); }
constexpr std::uint32_t kCopyLine[] = {
    0x7230203, 0x10000,    0x8000b,    0x18,       0,       0x20011, 1,       0x20011, 0x2b,    0x6000b,
    1,         0x4c534c47, 0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x7000f, 4,
    4,         0x6e69616d, 0,          9,          0x11,    0x30010, 4,       7,       0x40047, 9,
    0x1e,      0,          0x40047,    0xd,        0x22,    0,       0x40047, 0xd,     0x21,    0,
    0x40047,   0x11,       0x1e,       0,          0x20013, 2,       0x30021, 3,       2,       0x30016,
    6,         0x20,       0x40017,    7,          6,       4,       0x40020, 8,       3,       7,
    0x4003b,   8,          9,          3,          0x90019, 0xa,     6,       0,       0,       0,
    0,         1,          0,          0x3001b,    0xb,     0xa,     0x40020, 0xc,     0,       0xb,
    0x4003b,   0xc,        0xd,        0,          0x40017, 0xf,     6,       2,       0x40020, 0x10,
    1,         0xf,        0x4003b,    0x10,       0x11,    1,       0x40015, 0x12,    0x20,    0,
    0x4002b,   0x12,       0x13,       0,          0x40020, 0x14,    1,       6,       0x50036, 2,
    4,         0,          3,          0x200f8,    5,       0x4003d, 0xb,     0xe,     0xd,     0x50041,
    0x14,      0x15,       0x11,       0x13,       0x4003d, 6,       0x16,    0x15,    0x50057, 7,
    0x17,      0xe,        0x16,       0x3003e,    9,       0x17,    0x100fd, 0x10038,
};

//     #version 450
//     layout(set = 0, binding = 0) uniform sampler2D picture;
//     layout(location = 0) in vec2 place;
//     void main() { gl_FragDepth = texture(picture, place).r; }
constexpr std::uint32_t kCopyDepth[] = {
    0x7230203,  0x10000,    0x8000b, 0x17,    0,       0x20011, 1,       0x6000b, 1,       0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x7000f, 4,       4,       0x6e69616d,
    0,          8,          0x10,    0x30010, 4,       7,       0x30010, 4,       0xc,     0x40047,
    8,          0xb,        0x16,    0x40047, 0xc,     0x22,    0,       0x40047, 0xc,     0x21,
    0,          0x40047,    0x10,    0x1e,    0,       0x20013, 2,       0x30021, 3,       2,
    0x30016,    6,          0x20,    0x40020, 7,       3,       6,       0x4003b, 7,       8,
    3,          0x90019,    9,       6,       1,       0,       0,       0,       1,       0,
    0x3001b,    0xa,        9,       0x40020, 0xb,     0,       0xa,     0x4003b, 0xb,     0xc,
    0,          0x40017,    0xe,     6,       2,       0x40020, 0xf,     1,       0xe,     0x4003b,
    0xf,        0x10,       1,       0x40017, 0x12,    6,       4,       0x50036, 2,       4,
    0,          3,          0x200f8, 5,       0x4003d, 0xa,     0xd,     0xc,     0x4003d, 0xe,
    0x11,       0x10,       0x50057, 0x12,    0x13,    0xd,     0x11,    0x50051, 6,       0x16,
    0x13,       0,          0x3003e, 8,       0x16,    0x100fd, 0x10038,
};

//     #version 450
//     void main() {}
constexpr std::uint32_t kNothing[] = {
    0x7230203,  0x10000,    0x8000b, 6,       0,       0x20011, 1,       0x6000b, 1, 0x4c534c47,
    0x6474732e, 0x3035342e, 0,       0x3000e, 0,       1,       0x5000f, 4,       4, 0x6e69616d,
    0,          0x30010,    4,       7,       0x20013, 2,       0x30021, 3,       2, 0x50036,
    2,          4,          0,       3,       0x200f8, 5,       0x100fd, 0x10038,
};

// clang-format on

std::span<const std::uint32_t> words_of(OwnShader which) {
  switch (which) {
    case OwnShader::kArea: return kArea;
    case OwnShader::kClear: return kClear;
    case OwnShader::kClearUnsigned: return kClearUnsigned;
    case OwnShader::kClearSigned: return kClearSigned;
    case OwnShader::kCopy: return kCopy;
    case OwnShader::kCopyLine: return kCopyLine;
    case OwnShader::kCopyDepth: return kCopyDepth;
    case OwnShader::kNothing: break;
  }
  return kNothing;
}

}  // namespace

std::vector<std::uint32_t> own_shader(OwnShader which, std::uint32_t location) {
  const std::span<const std::uint32_t> from = words_of(which);
  std::vector<std::uint32_t> words(from.begin(), from.end());
  constexpr std::uint32_t kDecorate = 4u << 16 | 71u,
                          kLocation = 30;  // of a clear: its output has the only one
  for (std::size_t at = 5; location > 0 && at < words.size(); at += words[at] >> 16)
    if (words[at] == kDecorate && words[at + 2] == kLocation) words[at + 3] = location;
  return words;
}

}  // namespace quadrille::capture
