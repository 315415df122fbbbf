/// Codes of block compression that lavapipe lacks, against another decoder by others: Mesa's OpenGL ES, which
/// unpacks ETC2, EAC and ASTC in software. Blocks of chance are uploaded, drawn to floats and read back.
#include <catch2/catch.hpp>

// clang-format off: before what includes it without the prototypes
#define GL_GLEXT_PROTOTYPES
// clang-format on
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl32.h>

#include <GLES2/gl2ext.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string_view>
#include <vector>

#include "models/texture/block/astc_header.h"
#include "models/texture/block/block_code.h"

namespace quadrille::lavapipe {
namespace {

using models::BlockCode;

constexpr std::uint32_t kBlocksAcross = 48, kBlocks = kBlocksAcross * kBlocksAcross;

/// A context without a window, current from then on. False: there is none here.
bool open_context() {
  static const bool opened = [] {
    const EGLDisplay display =
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) return false;
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &found) != EGL_TRUE || found == 0) return false;
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    return context != EGL_NO_CONTEXT &&
           eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE;
  }();
  if (!opened) WARN("skipped: no OpenGL ES 3 without a window");
  return opened;
}

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
    if (name == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))))
      return true;
  return false;
}

GLuint shader(GLenum stage, const char* source) {
  const GLuint made = glCreateShader(stage);
  glShaderSource(made, 1, &source, nullptr);
  glCompileShader(made);
  GLint good = 0;
  glGetShaderiv(made, GL_COMPILE_STATUS, &good);
  REQUIRE(good == GL_TRUE);
  return made;
}

/// A triangle over all of the target that shows each texel where it lies.
GLuint copying_program() {
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader(GL_VERTEX_SHADER, R"(#version 300 es
    void main() {
      vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
      gl_Position = vec4(corner, 0, 1);
    })"));
  glAttachShader(program, shader(GL_FRAGMENT_SHADER, R"(#version 300 es
    precision highp float;
    precision highp sampler2D;
    uniform sampler2D blocks;
    out vec4 color;
    void main() { color = texture(blocks, gl_FragCoord.xy / vec2(textureSize(blocks, 0))); })"));
  glLinkProgram(program);
  return program;
}

void bind_texture(GLenum internal, GLsizei width, GLsizei height, const std::vector<std::byte>& blocks) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glCompressedTexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, static_cast<GLsizei>(blocks.size()),
                         blocks.data());
  REQUIRE(glGetError() == GL_NO_ERROR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SRGB_DECODE_EXT, GL_SKIP_DECODE_EXT);
}

/// Four floats a texel, the row of texture coordinate 0 first.
std::vector<float> driver_texels(GLenum internal, const models::BlockCodeInfo& info,
                                 const std::vector<std::byte>& blocks) {
  const auto width = static_cast<GLsizei>(kBlocksAcross * info.width),
             height = static_cast<GLsizei>(kBlocksAcross * info.height);
  GLuint target = 0, frame = 0;
  glGenTextures(1, &target);
  glBindTexture(GL_TEXTURE_2D, target);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, height);
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
  REQUIRE(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
  bind_texture(internal, width, height, blocks);
  glViewport(0, 0, width, height);
  static const GLuint program = copying_program();
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<float> texels(std::size_t{4} * static_cast<std::size_t>(width) *
                            static_cast<std::size_t>(height));
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  REQUIRE(glGetError() == GL_NO_ERROR);
  return texels;
}

/// A decoded texel as a sampler would give it, channels that lack as (0, 0, 0, 1).
std::array<float, 4> our_texel(BlockCode code, const models::BlockTexels& texels, std::size_t texel) {
  const models::BlockCodeInfo& info = models::block_code_info(code);
  const bool is_signed = code == BlockCode::kEacR11Snorm || code == BlockCode::kEacR11G11Snorm;
  const bool wide = info.decoded != models::DecodedTexels::kRgba8;
  std::array<float, 4> value{0, 0, 0, 1};
  const std::byte* const at = texels.bytes.data() + texel * info.decoded_bytes;
  for (std::size_t c = 0; c < (wide ? info.decoded_bytes / 2u : 4u); ++c) {
    if (!wide) {
      value[c] = static_cast<float>(at[c]) / 255.0f;
      continue;
    }
    std::uint16_t bits = 0;
    std::memcpy(&bits, at + 2 * c, sizeof bits);
    value[c] = is_signed ? static_cast<float>(static_cast<std::int16_t>(bits)) / 32767.0f
                         : static_cast<float>(bits) / 65535.0f;
  }
  return value;
}

/// Blocks of chance; of ASTC every other one is legal, and none of one colour: Mesa does not look whether
/// their extents are legal (tests/models/texture/astc_test.cpp has them).
std::vector<std::byte> chance_blocks(BlockCode code) {
  std::mt19937 random(static_cast<unsigned>(code) + 1);
  const models::BlockCodeInfo& info = models::block_code_info(code);
  std::vector<std::byte> blocks;
  while (blocks.size() < std::size_t{kBlocks} * info.bytes) {
    std::vector<std::byte> block(info.bytes);
    for (std::byte& b : block) b = static_cast<std::byte>(random() >> 8 & 0xff);
    const bool one_color =
        models::is_astc(code) && (static_cast<unsigned>(block[1]) & 1) == 1 && block[0] == std::byte{0xfc};
    if (one_color) continue;
    const bool wants_legal = models::is_astc(code) && blocks.size() / info.bytes % 2 == 0;
    if (wants_legal && !models::astc_header(models::AstcBits(block), info.width, info.height)) continue;
    blocks.insert(blocks.end(), block.begin(), block.end());
  }
  return blocks;
}

struct Difference {
  double largest = 0;
  std::size_t blocks = 0;
};

Difference difference(BlockCode code, GLenum internal) {
  const models::BlockCodeInfo& info = models::block_code_info(code);
  const std::vector<std::byte> blocks = chance_blocks(code);
  const std::vector<float> driver = driver_texels(internal, info, blocks);
  Difference found;
  models::BlockTexels texels;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    models::decode_block(code, std::span(blocks).subspan(block * info.bytes, info.bytes), texels);
    double most = 0;
    for (std::size_t i = 0; i < info.texels(); ++i) {
      const std::size_t x = block % kBlocksAcross * info.width + i % info.width,
                        y = block / kBlocksAcross * info.height + i / info.width;
      const std::array<float, 4> ours = our_texel(code, texels, i);
      for (std::size_t c = 0; c < 4; ++c)
        most = std::max(
            most, std::abs(double{ours[c]} - double{driver[4 * (y * kBlocksAcross * info.width + x) + c]}));
    }
    if (most > 1e-6) ++found.blocks;
    found.largest = std::max(found.largest, most);
  }
  return found;
}

}  // namespace

TEST_CASE("OpenGL ES: blocks of ETC2 and EAC decode to the same numbers") {
  if (!open_context()) return;
  constexpr std::pair<BlockCode, GLenum> kCodes[] = {
      {BlockCode::kEtc2Rgb8, GL_COMPRESSED_RGB8_ETC2},
      {BlockCode::kEtc2Rgb8A1, GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2},
      {BlockCode::kEtc2Rgba8, GL_COMPRESSED_RGBA8_ETC2_EAC},
      {BlockCode::kEacR11Unorm, GL_COMPRESSED_R11_EAC},
      {BlockCode::kEacR11Snorm, GL_COMPRESSED_SIGNED_R11_EAC},
      {BlockCode::kEacR11G11Unorm, GL_COMPRESSED_RG11_EAC},
      {BlockCode::kEacR11G11Snorm, GL_COMPRESSED_SIGNED_RG11_EAC}};
  for (const auto& [code, internal] : kCodes) {
    const Difference found = difference(code, internal);
    INFO(models::block_code_info(code).name << ": by up to " << found.largest);
    CHECK(found.blocks == 0);
  }
}

TEST_CASE("OpenGL ES: blocks of ASTC decode to the same bytes of sRGB in every size") {
  if (!open_context()) return;
  if (!has_extension("GL_KHR_texture_compression_astc_ldr")) {
    WARN("skipped: no ASTC");
    return;
  }
  // Of linear texels it has halves.
  const auto first = static_cast<int>(BlockCode::kAstc4x4Srgb),
             last = static_cast<int>(models::kLastBlockCode);
  for (int c = first; c <= last; c += 2) {
    const auto code = static_cast<BlockCode>(c);
    const Difference found =
        difference(code, static_cast<GLenum>(GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR + (c - first) / 2));
    INFO(models::block_code_info(code).name << ": by up to " << found.largest);
    CHECK(found.blocks == 0);
  }
}

}  // namespace quadrille::lavapipe
